#include "lodestone/points/normals.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "lodestone/base/parallel.h"
#include "lodestone/core/validate.h"
#include "lodestone/math/symmetric.h"
#include "lodestone/points/orient_detail.h"
#include "lodestone/spatial/kd_tree.h"

namespace lodestone::points {

namespace {

using spatial::KdTree;
using spatial::Neighbor;

constexpr std::uint32_t kMostNeighbors = 64;

Result<void> check(const PointCloud& cloud, const NormalOptions& options, const Task& task) {
  if (cloud.positions.empty()) return fail(ErrorCode::empty, "there are no points", "normals");
  if (options.neighbors < 3 || options.neighbors > kMostNeighbors) {
    return fail(ErrorCode::bad_argument, fmt::format("{} neighbours can't be used", options.neighbors), "normals",
                "use 3 to 64");
  }
  if (options.graph_neighbors < 1 || options.graph_neighbors > kMostNeighbors) {
    return fail(ErrorCode::bad_argument, fmt::format("{} neighbours can't be used", options.graph_neighbors), "normals",
                "use 1 to 64");
  }
  return validate(cloud, task);
}

// The axis along which a point and its neighbours spread least.
Vec3f plane_normal(std::span<const Vec3f> positions, std::uint32_t point, std::span<const Neighbor> near) {
  Vec3d middle;
  for (const Neighbor& n : near) middle += to_double(positions[n.point] - positions[point]);
  middle = middle / static_cast<double>(near.size() + 1);
  Symmetric3d spread;
  spread.add(middle, 1);
  for (const Neighbor& n : near) spread.add(to_double(positions[n.point] - positions[point]) - middle, 1);
  // To about one, so that small models lose nothing.
  const double size = spread.rows[0].x + spread.rows[1].y + spread.rows[2].z;
  if (!(size > 0) || !std::isfinite(size)) return {};
  for (Vec3d& row : spread.rows) row = row / size;
  const std::array<Vec3d, 3> axes = axes_of(spread);
  const double first = spread.form(axes[0]), second = spread.form(axes[1]), third = spread.form(axes[2]);
  const Vec3d least = first <= second && first <= third ? axes[0] : second <= third ? axes[1] : axes[2];
  return to_float(normalized(least));
}

// Rows of the graph for points in the tree's order.
class GraphRows {
 public:
  GraphRows(const KdTree& tree, std::size_t k) : slot_of_(tree.size()) {
    graph.k = std::min<std::size_t>(k, std::max<std::size_t>(1, tree.size() - 1));
    graph.neighbors.assign(graph.k * tree.size(), detail::Graph::kNobody);
    const auto order = tree.order();
    for (std::uint32_t slot = 0; slot < order.size(); ++slot) slot_of_[order[slot]] = slot;
  }
  void set(std::uint32_t point, std::span<const Neighbor> near) {
    std::uint32_t* row = graph.neighbors.data() + graph.k * slot_of_[point];
    for (std::size_t i = 0; i < std::min(graph.k, near.size()); ++i) row[i] = slot_of_[near[i].point];
  }
  detail::Graph graph;

 private:
  std::vector<std::uint32_t> slot_of_;
};

template <class T>
std::vector<T> in_order(const std::vector<T>& values, std::span<const std::uint32_t> order) {
  std::vector<T> out(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) out[i] = values[order[i]];
  return out;
}

Result<Normals> oriented(const PointCloud& cloud, const KdTree& tree, const detail::Graph& graph, Normals out,
                         const Task& task) {
  std::vector<Vec3f> normals = in_order(out.normals, tree.order());
  out.pieces = detail::orient(graph, in_order(cloud.positions, tree.order()), normals, task);
  if (task.cancelled()) return cancelled_error("normals");
  for (std::size_t i = 0; i < normals.size(); ++i) out.normals[tree.order()[i]] = normals[i];
  out.unknown =
      static_cast<std::uint64_t>(std::count_if(normals.begin(), normals.end(), [](Vec3f n) { return n == Vec3f{}; }));
  return out;
}

}  // namespace

Result<Normals> estimate_normals(const PointCloud& cloud, const NormalOptions& options, const Task& task) {
  LODESTONE_TRY(check(cloud, options, task));
  const KdTree tree(cloud.positions, task.part(0.2));
  GraphRows rows(tree, options.graph_neighbors);
  Normals out;
  out.normals.resize(cloud.size());
  tree.each_neighborhood(std::max(options.neighbors, options.graph_neighbors), task.part(0.5),
                         [&](std::uint32_t point, std::span<const Neighbor> near) {
                           rows.set(point, near);
                           out.normals[point] =
                               plane_normal(cloud.positions, point,
                                            near.first(std::min<std::size_t>(near.size(), options.neighbors)));
                         });
  return oriented(cloud, tree, rows.graph, std::move(out), task.part(0.3));
}

Result<Normals> orient_normals(const PointCloud& cloud, const NormalOptions& options, const Task& task) {
  LODESTONE_TRY(check(cloud, options, task));
  if (cloud.normals.size() != cloud.size()) {
    return fail(ErrorCode::bad_argument, fmt::format("{} points have {} normals", cloud.size(), cloud.normals.size()),
                "normals", "estimate them");
  }
  const KdTree tree(cloud.positions, task.part(0.2));
  GraphRows rows(tree, options.graph_neighbors);
  tree.each_neighborhood(options.graph_neighbors, task.part(0.4),
                         [&](std::uint32_t point, std::span<const Neighbor> near) { rows.set(point, near); });
  Normals out;
  out.normals = cloud.normals;
  return oriented(cloud, tree, rows.graph, std::move(out), task.part(0.4));
}

double outward_share(const PointCloud& cloud) {
  int outward = 0, known = 0;
  for (int i = 0; i < 27; ++i) {
    const int x = i % 3 - 1, y = i / 3 % 3 - 1, z = i / 9 - 1;
    const Vec3f direction{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
    float farthest = -std::numeric_limits<float>::infinity(), looks = 0;
    for (std::size_t p = 0; p < cloud.normals.size(); ++p) {
      const float along = dot(cloud.positions[p], direction);
      if (!(along > farthest) || cloud.normals[p] == Vec3f{}) continue;
      farthest = along;
      looks = dot(cloud.normals[p], direction);
    }
    if (looks == 0) continue;  // the middle, or no normal
    ++known;
    if (looks > 0) ++outward;
  }
  return known == 0 ? 1.0 : static_cast<double>(outward) / known;
}

}  // namespace lodestone::points
