// A surface with its distance to another one, place by place, as numbers and colours.
//
// Problem: vertices of a simplified mesh lie near the original, so distances at vertices alone show next to nothing.
// Method: triangles are split until straight lines between vertices tell the distance.
// 1. distances(): closest points, in batches.
// 2. refine(): in rounds, sides_to_split() measures the middles of new sides and the centres of new triangles. Sides
//    are split where the ends don't say what was measured, and where they are too long; detail::split_sides() cuts both
//    triangles beside a side.
// 3. area_percentile(): the distance that 99 % of the area is nearer than, by halving; share_below() is exact for
//    distances that are linear within a triangle.
// 4. mesh_of(): the stream `_ERROR`, and a colour for it.
// Invariants: no cracks, faces keep their direction, and vertices that were there stay. Sums are joined in the order of
// chunks: the same bytes for any thread count. Cost: O(n log n), n being the triangles after splitting; at most
// kMostRounds rounds, and never more than `most_triangles`, unless the surface has more itself.
#include "lodestone/measure/heat.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "lodestone/base/parallel.h"
#include "lodestone/measure/split_detail.h"
#include "lodestone/render/color_map.h"
#include "lodestone/spatial/bvh.h"
#include "lodestone/spatial/closest_batch.h"
#include "lodestone/spatial/surface.h"

namespace lodestone::measure {

namespace {

using detail::EdgeKey;

constexpr std::size_t kChunk = 4096;
constexpr double kNothing = 1e-9;  // of the diagonal: rounding
constexpr int kMostRounds = 8;     // of splitting: a side becomes 1/256 of what it was

// The surface while it is split, with the distance of each vertex.
struct Field {
  std::vector<Vec3d> positions;
  std::vector<Triangle> triangles;
  std::vector<double> distance;
  std::size_t first_new = 0;  // vertices from here on came in the last round
};

std::vector<double> distances(const spatial::Bvh& to, std::span<const Vec3d> points, const Task& task) {
  std::vector<double> out(points.size());
  parallel_for(points.size(), kChunk, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    std::vector<spatial::Nearest> closest(end - begin);
    spatial::ClosestBatch(to).find(points.subspan(begin, end - begin), closest);
    for (std::size_t i = begin; i < end; ++i) out[i] = std::sqrt(closest[i - begin].distance_sq);
  });
  return out;
}

double largest_of(const std::vector<double>& values) {
  return values.empty() ? 0 : *std::max_element(values.begin(), values.end());
}

// Sides of triangles that have a new vertex, longer than `shortest`.
std::vector<EdgeKey> new_sides(const Field& field, double shortest, const Task& task) {
  std::vector<EdgeKey> sides;
  for (const Triangle& t : field.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const EdgeKey side = detail::edge_of(t[k], t[(k + 1) % 3]);
      if (side.high < field.first_new) continue;
      if (length(field.positions[side.low] - field.positions[side.high]) > shortest) sides.push_back(side);
    }
  }
  detail::sort_unique(sides, task);
  return sides;
}

// Triangles with a new vertex and all sides longer than `shortest`.
std::vector<std::uint32_t> new_triangles(const Field& field, double shortest) {
  std::vector<std::uint32_t> out;
  for (std::size_t i = 0; i < field.triangles.size(); ++i) {
    const Triangle& t = field.triangles[i];
    if (std::max({t[0], t[1], t[2]}) < field.first_new) continue;
    bool is_long = true;
    for (std::size_t k = 0; k < 3; ++k) {
      is_long = is_long && length(field.positions[t[k]] - field.positions[t[(k + 1) % 3]]) > shortest;
    }
    if (is_long) out.push_back(static_cast<std::uint32_t>(i));
  }
  return out;
}

struct SplitRules {
  double shortest, longest;  // sides, model units
  double tolerance;          // of the largest distance
  double nothing;            // distances below are rounding
};

// The sides to be split: those where the distance in the middle is not what the ends say, those of triangles where that
// at the centre is not what the corners say, and long ones.
std::vector<EdgeKey> sides_to_split(const Field& field, const spatial::Bvh& to, const SplitRules& rules,
                                    double& largest, const Task& task) {
  const std::vector<EdgeKey> sides = new_sides(field, rules.shortest, task);
  const std::vector<std::uint32_t> triangles = new_triangles(field, rules.shortest);
  std::vector<Vec3d> points;
  points.reserve(sides.size() + triangles.size());
  for (const EdgeKey& side : sides) points.push_back(detail::middle_of(field.positions, side));
  for (const std::uint32_t t : triangles) {
    const Triangle& c = field.triangles[t];
    points.push_back((field.positions[c[0]] + field.positions[c[1]] + field.positions[c[2]]) * (1.0 / 3));
  }
  const std::vector<double> found = distances(to, points, task);
  largest = std::max(largest, largest_of(found));

  std::vector<EdgeKey> out;
  const double most = std::max(rules.tolerance * largest, rules.nothing);
  const std::vector<double>& d = field.distance;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const bool is_long = length(field.positions[sides[i].low] - field.positions[sides[i].high]) > rules.longest;
    if (is_long || std::abs(found[i] - (d[sides[i].low] + d[sides[i].high]) / 2) > most) out.push_back(sides[i]);
  }
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const Triangle& t = field.triangles[triangles[i]];
    if (std::abs(found[sides.size() + i] - (d[t[0]] + d[t[1]] + d[t[2]]) / 3) <= most) continue;
    for (std::size_t k = 0; k < 3; ++k) out.push_back(detail::edge_of(t[k], t[(k + 1) % 3]));
  }
  detail::sort_unique(out, task);
  return out;
}

// Splits until straight lines between the vertices tell the distance.
void refine(Field& field, const spatial::Bvh& to, double diagonal, const HeatOptions& options, const Task& task) {
  double largest = largest_of(field.distance);  // of vertices and of what was looked at between them
  const SplitRules rules{options.shortest_side * diagonal, options.longest_side * diagonal, options.tolerance,
                         kNothing * diagonal};
  for (int round = 0; round < kMostRounds && !task.cancelled(); ++round) {
    const std::vector<EdgeKey> sides = sides_to_split(field, to, rules, largest, task);
    if (sides.empty()) return;
    std::vector<Triangle> split = detail::split_sides(field.triangles, sides, field.positions.size());
    if (split.size() > options.most_triangles) return;
    field.triangles = std::move(split);
    field.first_new = field.positions.size();
    for (const EdgeKey& side : sides) field.positions.push_back(detail::middle_of(field.positions, side));
    const std::vector<double> added =
        distances(to, std::span<const Vec3d>(field.positions).subspan(field.first_new), task);
    field.distance.insert(field.distance.end(), added.begin(), added.end());
  }
}

// Which share of a triangle's area is nearer than `distance`, linear between its corners.
double share_below(double distance, double a, double b, double c) {
  if (a > b) std::swap(a, b);
  if (b > c) std::swap(b, c);
  if (a > b) std::swap(a, b);
  if (distance <= a) return 0;
  if (distance >= c) return 1;
  if (distance < b) return (distance - a) * (distance - a) / ((b - a) * (c - a));
  return 1 - (c - distance) * (c - distance) / ((c - b) * (c - a));
}

// The distance that `share` of the area is nearer than, by halving; the largest where there is no area.
double area_percentile(const Field& field, double share, double largest, const Task& task) {
  const auto area_below = [&](double distance) {
    return parallel_reduce(
        field.triangles.size(), kChunk * 16, task, 0.0,
        [&](std::size_t begin, std::size_t end) {
          double sum = 0;
          for (std::size_t i = begin; i < end; ++i) {
            const Triangle& t = field.triangles[i];
            const Vec3d a = field.positions[t[0]], b = field.positions[t[1]], c = field.positions[t[2]];
            sum += length(cross(b - a, c - a)) *
                   share_below(distance, field.distance[t[0]], field.distance[t[1]], field.distance[t[2]]);
          }
          return sum;
        },
        [](double a, double b) { return a + b; });
  };
  const double total = area_below(std::numeric_limits<double>::infinity());
  double low = 0, high = largest;
  for (int round = 0; round < 24 && total > 0; ++round) {
    const double middle = (low + high) / 2;
    (area_below(middle) < share * total ? low : high) = middle;
  }
  return high;
}

Mesh mesh_of(Field field, Vec3d offset, double range, bool linear_colors) {
  Mesh mesh;
  mesh.offset = offset;
  const std::size_t n = field.positions.size();
  AttributeStream error = make_stream("_ERROR", Semantic::generic, 1, ComponentType::float32, false, n);
  AttributeStream color = make_stream("COLOR_0", Semantic::color, 3, ComponentType::uint8, true, n);
  auto& errors = std::get<std::vector<float>>(error.values);
  auto& colors = std::get<std::vector<float>>(color.values);
  mesh.positions.reserve(n);
  for (std::size_t v = 0; v < n; ++v) {
    mesh.positions.push_back(to_float(field.positions[v] - offset));
    errors[v] = static_cast<float>(field.distance[v]);
    const float share = range > 0 ? static_cast<float>(field.distance[v] / range) : 0.0F;
    const Vec3f rgb = linear_colors ? render::heat_light(share) : render::heat_color(share);
    for (std::size_t k = 0; k < 3; ++k) colors[3 * v + k] = rgb[k];
  }
  mesh.triangles = std::move(field.triangles);
  mesh.attributes.push_back(std::move(error));
  mesh.attributes.push_back(std::move(color));
  return mesh;
}

}  // namespace

Result<Heat> heat_map(const Model& a, const Model& b, const HeatOptions& options, Task task) {
  Result<spatial::Surface> from = spatial::flatten(a, options.input, task.part(0.2));
  LODESTONE_TRY(from);
  const Result<spatial::Surface> other = spatial::flatten(b, options.input, task.part(0.1));
  LODESTONE_TRY(other);
  const spatial::Bvh to(*other, task.part(0.1));

  Heat heat;
  heat.triangles = from->triangles.size();
  const double diagonal = from->bounds.diagonal();
  const Vec3d offset = from->bounds.center();
  Field field{std::move(from->positions), std::move(from->triangles), {}, 0};
  field.distance = distances(to, field.positions, task);
  refine(field, to, diagonal, options, task);
  if (task.cancelled()) return cancelled_error("heat map");
  heat.largest = largest_of(field.distance);
  heat.percentile_99 = area_percentile(field, 0.99, heat.largest, task);
  // What is nothing but rounding gets no colours, and few places that are far off don't leave all else to rounding.
  heat.range = heat.largest > kNothing * diagonal ? std::max(heat.percentile_99, heat.largest / 20) : 0;
  heat.model = make_model(mesh_of(std::move(field), offset, heat.range, options.linear_colors), a);
  return heat;
}

}  // namespace lodestone::measure
