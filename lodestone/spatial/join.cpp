// Steps    border vertices -> mutual nearest -> pairs that keep edges manifold, the nearest first -> { drop those that
//          turn a triangle or share no sewn edge } until none does -> move
#include "lodestone/spatial/join.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <tuple>

#include "lodestone/base/parallel.h"
#include "lodestone/core/adjacency.h"
#include "lodestone/core/parts.h"
#include "lodestone/math/triangle.h"
#include "lodestone/spatial/part_tree.h"

namespace lodestone::spatial {

namespace {

constexpr std::size_t kChunk = 1024;

struct Pair {
  std::uint32_t a, b;  // a < b
  double distance_sq;
};

// Both ends' neighbours along borders, by vertex.
struct Borders {
  std::vector<std::uint32_t> first, neighbours;

  std::span<const std::uint32_t> of(std::uint32_t v) const {
    return std::span(neighbours).subspan(first[v], first[v + 1] - first[v]);
  }
};

Borders borders_of(const Mesh& mesh, const Task& task) {
  Borders borders;
  const EdgeTriangles edges = edge_triangles(mesh, task);
  borders.first.assign(mesh.vertex_count() + 1, 0);
  for (const Edge& e : edges.edges) {
    if (e.count != 1) continue;
    ++borders.first[e.a];
    ++borders.first[e.b];
  }
  borders.neighbours.resize(exclusive_scan(borders.first));
  std::vector<std::uint32_t> next = borders.first;
  for (const Edge& e : edges.edges) {
    if (e.count != 1) continue;
    borders.neighbours[next[e.a]++] = e.b;
    borders.neighbours[next[e.b]++] = e.a;
  }
  return borders;
}

class Joiner {
 public:
  Joiner(Mesh& mesh, const std::vector<std::uint8_t>& locked, const Task& task)
      : mesh_(mesh), locked_(locked), task_(task), borders_(borders_of(mesh, task)), stars_(vertex_triangles(mesh)) {
    partner_.assign(mesh.vertex_count(), kNone);
  }

  std::size_t run(double tolerance) {
    for (const Pair& pair : near_pairs(tolerance)) {
      if (!keeps_edges(pair)) continue;
      pairs_.push_back(pair);
      partner_[pair.a] = pair.b;
      partner_[pair.b] = pair.a;
    }
    // What is dropped can leave others without a sewn edge, or turn what was right only together with it.
    bool dropped = true;
    while (dropped && !task_.cancelled()) {
      dropped = drop([&](const Pair& pair) { return !is_sewn(pair); });
      if (drop([&](const Pair& pair) { return turns(pair); })) dropped = true;
    }
    for (const Pair& pair : pairs_) mesh_.positions[mover(pair)] = mesh_.positions[stayer(pair)];
    return pairs_.size();
  }

 private:
  bool is_locked(std::uint32_t v) const { return !locked_.empty() && locked_[v] != 0; }
  std::uint32_t mover(const Pair& pair) const { return is_locked(pair.b) ? pair.a : pair.b; }
  std::uint32_t stayer(const Pair& pair) const { return is_locked(pair.b) ? pair.b : pair.a; }
  std::uint32_t name_of(std::uint32_t v) const { return partner_[v] == kNone ? v : std::min(v, partner_[v]); }

  // Each other's nearest border vertices of different parts, the nearest pairs first.
  std::vector<Pair> near_pairs(double tolerance) {
    const Parts parts = parts_of(mesh_);
    std::vector<Vec3d> positions(mesh_.vertex_count());
    std::vector<Triangle> points;  // a tree of triangles serves for points as well
    for (std::uint32_t v = 0; v < positions.size(); ++v) {
      positions[v] = to_double(mesh_.positions[v]);
      if (!borders_.of(v).empty() && parts.of_vertex[v] != kNone) points.push_back({v, v, v});
    }
    if (points.empty()) return {};
    const PartTree tree(positions, points, parts.of_vertex, parts.count, task_);
    std::vector<NearestPart> nearest(positions.size());
    parallel_for(points.size(), kChunk, task_, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t i = begin; i < end; ++i) {
        const std::uint32_t v = points[i][0], own = parts.of_vertex[v];
        nearest[v] = tree.nearest(
            positions[v], [own](std::uint32_t q) { return q != own; }, tolerance * tolerance);
      }
    });
    std::vector<Pair> pairs;
    for (const Triangle& point : points) {
      const std::uint32_t a = point[0], b = nearest[a].vertex;
      if (b == kNone || b < a || nearest[b].vertex != a || (is_locked(a) && is_locked(b))) continue;
      pairs.push_back({a, b, nearest[a].distance_sq});
    }
    std::sort(pairs.begin(), pairs.end(),
              [](const Pair& x, const Pair& y) { return std::tie(x.distance_sq, x.a) < std::tie(y.distance_sq, y.a); });
    return pairs;
  }

  // The triangles around a vertex: the others' corners, in their order, under the names that they have so far.
  void gather(std::uint32_t v, std::vector<std::array<std::uint32_t, 2>>& out) const {
    out.clear();
    for (const std::uint32_t t : stars_.of(v)) {
      const Triangle c = mesh_.vertices_of(t);
      if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]) continue;
      const std::size_t k = c[0] == v ? 0 : c[1] == v ? 1 : 2;
      out.push_back({name_of(c[(k + 1) % 3]), name_of(c[(k + 2) % 3])});
    }
  }

  // Edges that fall together must be walked both ways once, and no two triangles may have the same corners.
  bool keeps_edges(const Pair& pair) {
    gather(pair.a, around_a_);
    gather(pair.b, around_b_);
    for (const auto& x : around_a_) {
      for (const auto& y : around_b_) {
        const bool same = (x[0] == y[0] && x[1] == y[1]) || (x[0] == y[1] && x[1] == y[0]);
        if (same || x[0] == y[0] || x[1] == y[1]) return false;
      }
    }
    // x walks the edge out, y back, or the other way round: each may do so once.
    const auto times = [&](const std::vector<std::array<std::uint32_t, 2>>& around, std::uint32_t name) {
      std::size_t n = 0;
      for (const auto& x : around) n += (x[0] == name ? 1U : 0U) + (x[1] == name ? 1U : 0U);
      return n;
    };
    for (const auto& x : around_a_) {
      for (const std::uint32_t name : x) {
        const std::size_t there = times(around_b_, name);
        if (there > 0 && times(around_a_, name) + there > 2) return false;
      }
    }
    return true;
  }

  bool is_sewn(const Pair& pair) const {
    const auto there = borders_.of(pair.b);
    return std::any_of(borders_.of(pair.a).begin(), borders_.of(pair.a).end(), [&](std::uint32_t v) {
      return partner_[v] != kNone && std::find(there.begin(), there.end(), partner_[v]) != there.end();
    });
  }

  Vec3d moved(std::uint32_t v) const {
    if (partner_[v] == kNone) return to_double(mesh_.positions[v]);
    const Pair pair{name_of(v), std::max(v, partner_[v]), 0};
    return to_double(mesh_.positions[stayer(pair)]);
  }

  bool turns(const Pair& pair) const {
    for (const std::uint32_t t : stars_.of(mover(pair))) {
      const Triangle c = mesh_.vertices_of(t);
      const Vec3d before = scaled_normal(to_double(mesh_.positions[c[0]]), to_double(mesh_.positions[c[1]]),
                                         to_double(mesh_.positions[c[2]]));
      if (before == Vec3d{}) continue;
      if (!(dot(before, scaled_normal(moved(c[0]), moved(c[1]), moved(c[2]))) > 0)) return true;
    }
    return false;
  }

  template <class Bad>
  bool drop(const Bad& bad) {
    std::vector<Pair> kept, gone;
    for (const Pair& pair : pairs_) (bad(pair) ? gone : kept).push_back(pair);
    for (const Pair& pair : gone) partner_[pair.a] = partner_[pair.b] = kNone;
    pairs_ = std::move(kept);
    return !gone.empty();
  }

  Mesh& mesh_;
  const std::vector<std::uint8_t>& locked_;
  const Task& task_;
  Borders borders_;
  VertexTriangles stars_;
  std::vector<Pair> pairs_;             // accepted
  std::vector<std::uint32_t> partner_;  // of each vertex in them
  std::vector<std::array<std::uint32_t, 2>> around_a_, around_b_;
};

}  // namespace

Result<std::size_t> join_parts(Mesh& mesh, double tolerance, const std::vector<std::uint8_t>& locked, Task task) {
  if (!(tolerance > 0) || !std::isfinite(tolerance)) {
    return fail(ErrorCode::bad_argument, "the joining distance is not a length above 0", "joining");
  }
  if (!locked.empty() && locked.size() != mesh.vertex_count()) {
    return fail(ErrorCode::bad_argument, "the list of locked vertices has another length than the mesh's vertices",
                "joining", "give one entry a vertex");
  }
  const std::size_t moved = Joiner(mesh, locked, task).run(tolerance);
  if (task.cancelled()) return cancelled_error("joining");
  return moved;
}

}  // namespace lodestone::spatial
