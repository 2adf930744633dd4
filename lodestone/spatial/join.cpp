// Sews borders that were meant to meet: border vertices of different parts get the same position, so that exact welding
// makes one vertex of them (docs/thin-parts.md, "How parts are joined").
//
// join_parts() runs rounds on a copy of the mesh (Sewn) until a round finds no pair; positions change at the very end.
// Round::run():
// 1. near_pairs(): border vertices that are each other's nearest and have no part in common, the nearest pairs first.
// 2. A pair is taken if no vertex would end farther from where it began than the tolerance (stays_near()), and if edges
//    stay manifold with it (keeps_edges()).
// 3. Pairs are dropped again, until none is bad, if they share no sewn edge with another (is_sewn()) or turn a triangle
//    over (turns()). Dropping one can make others bad.
// 4. What is left is joined under one name (Sewn::join(), rename()). Corners of several parts close in later rounds.
//
// Locked vertices do not move. No vertex is joined to another of its own part. Pairs are sorted by distance, equal ones
// by number: the same for any number of threads. O(n log n) a round, kMostRounds rounds at most.
#include "lodestone/spatial/join.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <tuple>

#include "lodestone/base/parallel.h"
#include "lodestone/core/adjacency.h"
#include "lodestone/core/parts.h"
#include "lodestone/core/validate.h"
#include "lodestone/math/triangle.h"
#include "lodestone/spatial/part_tree.h"

namespace lodestone::spatial {

namespace {

constexpr std::size_t kChunk = 1024;

// Where n parts meet in a corner log2(n) rounds join them.
constexpr int kMostRounds = 8;

struct Pair {
  std::uint32_t a, b;  // a < b
  double distance_sq;
};

// The mesh as it is sewn so far: `mesh` has vertices for wedges, and each joined vertex goes by the name of the one
// whose place it takes.
struct Sewn {
  Mesh mesh;
  Parts parts;                       // of the original: nothing is ever joined to another vertex of its own part
  std::vector<std::uint32_t> names;  // one a vertex of the original
  std::vector<std::uint32_t> next;   // the vertices of one name, in a ring

  explicit Sewn(const Mesh& original) : parts(parts_of(original)), names(original.vertex_count()) {
    mesh.positions = original.positions;
    mesh.triangles.resize(original.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) mesh.triangles[t] = original.vertices_of(t);
    std::iota(names.begin(), names.end(), 0U);
    next = names;
  }

  template <class Each>
  bool all_of(std::uint32_t name, const Each& each) const {
    for (std::uint32_t v = name;;) {
      if (!each(v)) return false;
      v = next[v];
      if (v == name) return true;
    }
  }
  bool is_single(std::uint32_t name) const { return next[name] == name; }
  bool share_part(std::uint32_t a, std::uint32_t b) const {
    return !all_of(a, [&](std::uint32_t x) {
      return all_of(b, [&](std::uint32_t y) { return parts.of_vertex[x] != parts.of_vertex[y]; });
    });
  }
  void join(std::uint32_t mover, std::uint32_t stayer) {
    all_of(mover, [&](std::uint32_t v) {
      names[v] = stayer;
      return true;
    });
    std::swap(next[mover], next[stayer]);
  }
  void rename() {
    for (Triangle& t : mesh.triangles) {
      for (std::uint32_t& v : t) v = names[v];
    }
  }
};

// For each vertex, its neighbours along borders.
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

class Round {
 public:
  Round(const Mesh& original, Sewn& sewn, const std::vector<std::uint8_t>& locked, const Task& task)
      : original_(original),
        sewn_(sewn),
        mesh_(sewn.mesh),
        locked_(locked),
        task_(task),
        borders_(borders_of(mesh_, task)),
        stars_(vertex_triangles(mesh_)) {
    partner_.assign(mesh_.vertex_count(), kNone);
  }

  // Joins what it can and returns how many pairs.
  std::size_t run(double tolerance) {
    for (const Pair& pair : near_pairs(tolerance)) {
      if (!stays_near(pair, tolerance) || !keeps_edges(pair)) continue;
      pairs_.push_back(pair);
      partner_[pair.a] = pair.b;
      partner_[pair.b] = pair.a;
    }
    // Dropping a pair can leave others without a sewn edge, or turn triangles that were right only together with it.
    bool dropped = true;
    while (dropped && !task_.cancelled()) {
      dropped = drop([&](const Pair& pair) { return !is_sewn(pair); });
      if (drop([&](const Pair& pair) { return turns(pair); })) dropped = true;
    }
    for (const Pair& pair : pairs_) sewn_.join(mover(pair), stayer(pair));
    sewn_.rename();
    return pairs_.size();
  }

 private:
  bool is_locked(std::uint32_t name) const {
    return !locked_.empty() && !sewn_.all_of(name, [&](std::uint32_t v) { return locked_[v] == 0; });
  }
  std::uint32_t mover(const Pair& pair) const { return is_locked(pair.b) ? pair.a : pair.b; }
  std::uint32_t stayer(const Pair& pair) const { return is_locked(pair.b) ? pair.b : pair.a; }
  std::uint32_t name_of(std::uint32_t v) const { return partner_[v] == kNone ? v : std::min(v, partner_[v]); }

  // Each other's nearest border vertices without a part in common, the nearest pairs first.
  std::vector<Pair> near_pairs(double tolerance) {
    // A vertex that is joined already belongs to several parts: it makes a group of its own.
    std::vector<std::uint32_t> group(mesh_.vertex_count(), kNone), single;
    std::vector<Vec3d> positions(mesh_.vertex_count());
    std::vector<Triangle> points;  // a tree of triangles serves for points as well
    for (std::uint32_t v = 0; v < positions.size(); ++v) {
      positions[v] = to_double(mesh_.positions[v]);
      if (borders_.of(v).empty()) continue;
      points.push_back({v, v, v});
      group[v] = sewn_.parts.of_vertex[v];
      if (sewn_.is_single(v)) continue;
      group[v] = static_cast<std::uint32_t>(sewn_.parts.count + single.size());
      single.push_back(v);
    }
    if (points.empty()) return {};
    const PartTree tree(positions, points, group, sewn_.parts.count + single.size(), task_);
    std::vector<NearestPart> nearest(positions.size());
    parallel_for(points.size(), kChunk, task_, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t i = begin; i < end; ++i) {
        const std::uint32_t v = points[i][0];
        const auto is_other = [&](std::uint32_t q) {
          if (q >= sewn_.parts.count) return !sewn_.share_part(v, single[q - sewn_.parts.count]);
          return sewn_.all_of(v, [&](std::uint32_t x) { return sewn_.parts.of_vertex[x] != q; });
        };
        nearest[v] = tree.nearest(positions[v], is_other, tolerance * tolerance);
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

  // Whether all vertices that would move end within the tolerance of where they began, in earlier rounds, too.
  bool stays_near(const Pair& pair, double tolerance) const {
    const Vec3d place = to_double(mesh_.positions[stayer(pair)]);
    return sewn_.all_of(mover(pair), [&](std::uint32_t v) {
      return length_sq(to_double(original_.positions[v]) - place) <= tolerance * tolerance;
    });
  }

  // For each triangle around a vertex, its other two corners in the triangle's order, under the names they have so far.
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

  // True if a border edge at either vertex ends at the same vertex, or at the two vertices of another pair.
  bool is_sewn(const Pair& pair) const {
    const auto here = borders_.of(pair.a), there = borders_.of(pair.b);
    const auto is_there = [&](std::uint32_t v) { return std::find(there.begin(), there.end(), v) != there.end(); };
    return std::any_of(here.begin(), here.end(),
                       [&](std::uint32_t v) { return is_there(v) || (partner_[v] != kNone && is_there(partner_[v])); });
  }

  Vec3d moved(std::uint32_t v) const {
    if (partner_[v] == kNone) return to_double(mesh_.positions[v]);
    const Pair pair{name_of(v), std::max(v, partner_[v]), 0};
    return to_double(mesh_.positions[stayer(pair)]);
  }

  bool turns(const Pair& pair) const {
    for (const std::uint32_t t : stars_.of(mover(pair))) {
      const Triangle c = mesh_.triangles[t], o = original_.vertices_of(t);
      const Vec3d before = scaled_normal(to_double(original_.positions[o[0]]), to_double(original_.positions[o[1]]),
                                         to_double(original_.positions[o[2]]));
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

  const Mesh& original_;
  Sewn& sewn_;
  const Mesh& mesh_;
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
  LODESTONE_TRY(validate(mesh, task));
  Sewn sewn(mesh);
  for (int round = 0; round < kMostRounds && !task.cancelled(); ++round) {
    if (Round(mesh, sewn, locked, task).run(tolerance) == 0) break;
  }
  if (task.cancelled()) return cancelled_error("joining");
  std::size_t moved = 0;
  for (std::uint32_t v = 0; v < sewn.names.size(); ++v) {
    mesh.positions[v] = sewn.mesh.positions[sewn.names[v]];
    moved += sewn.names[v] != v ? 1 : 0;
  }
  return moved;
}

}  // namespace lodestone::spatial
