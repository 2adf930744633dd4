// More triangles where a level is farthest from its original.
//
// split_worst() goes through the triangles above a share of the maximum, worst first. Splitter::split() makes one of
// three changes, by where on the triangle the largest distance was found:
// - near a corner, the vertex itself is pulled half way to the original (pull_in());
// - near a side, the side is split, and with it the triangle beyond (split_side());
// - elsewhere, a vertex is added within the triangle (split_face()).
// A new vertex goes all the way to the original. Where a face would then turn by more than some 70 degrees
// (looks_alike()) or cross another (crosses()), it goes half or a fourth of the way; if that fails, too, the triangle
// is left as it is. finish() mixes the attributes of new vertices from the corners' and carries over how the original
// differs there (carry_attributes()).
//
// No triangle is changed twice, so all tests look at the level as it was. Vertices on seams, between materials or where
// the surface is not manifold are not pulled; edges of three triangles and more are not split; nor are triangles around
// no_split vertices. Old vertices keep their numbers, new ones follow. Single-threaded, in a fixed order. O(n log n).
#include "lodestone/simplify/fit/split_worst.h"

#include <algorithm>
#include <array>
#include <limits>

#include "lodestone/core/adjacency.h"
#include "lodestone/core/blend.h"
#include "lodestone/math/box.h"
#include "lodestone/math/triangle.h"
#include "lodestone/simplify/fit/attributes_detail.h"
#include "lodestone/spatial/self_intersections.h"

namespace lodestone::simplify {

namespace {

// A wedge of a new vertex, with the values of another.
std::uint32_t add_wedge(Mesh& mesh, std::uint32_t vertex, std::uint32_t from) {
  const std::uint32_t wedge = mesh.wedge_vertex.empty() ? vertex : static_cast<std::uint32_t>(mesh.wedge_vertex.size());
  if (!mesh.wedge_vertex.empty()) mesh.wedge_vertex.push_back(vertex);
  for (AttributeStream& stream : mesh.attributes) {
    std::visit(
        [&](auto& values) {
          for (std::uint32_t c = 0; c < stream.components; ++c) {
            const auto value = values[std::size_t{from} * stream.components + c];
            values.push_back(value);
          }
        },
        stream.values);
  }
  return wedge;
}

constexpr double kPull = 0.5;
constexpr double kTurn = 0.3;       // cosine: a face may not turn farther
constexpr double kNearSide = 0.15;  // a corner's weight below which the place is on the side across

// A new vertex on a side or within a triangle: wedge `own` becomes its values, step by step.
struct Mix {
  std::uint32_t own, other;
  float share;
};

class Splitter {
 public:
  Splitter(const TrackedLevel& level, bool keep_borders, std::span<const std::uint8_t> no_move, const Task& task)
      : level_(level),
        task_(task),
        keep_borders_(keep_borders),
        mesh_(level.mesh()),
        edges_(edge_triangles(mesh_, task)),
        around_(vertex_triangles(mesh_)),
        tree_(level.surface(), task),
        touched_(mesh_.triangles.size(), 0),
        no_move_(no_move.begin(), no_move.end()) {
    no_move_.resize(mesh_.vertex_count(), 0);
    for (const Edge& edge : edges_.edges) {
      if (edge.count == 1 ? keep_borders : !is_smooth(edge)) no_move_[edge.a] = no_move_[edge.b] = 1;
    }
  }

  // How many triangles were added; 1 for a vertex that was pulled. The vertex goes all the way to the original, or half
  // or a fourth of it where faces would turn too far; fitting goes on from there.
  std::size_t split(std::uint32_t t, const TriangleError& worst) {
    for (const double way : {1.0, 0.5, 0.25}) {
      if (touched_[t] != 0) return 0;
      if (const std::size_t added = split(t, worst, way); added > 0) return added;
    }
    return 0;
  }

  void leave_around(std::uint32_t vertex) {
    for (const std::uint32_t t : around_.of(vertex)) touched_[t] = 1;
  }

  SplitResult finish() {
    AttributeBlender blender(mesh_.attributes);
    for (const Mix& mix : mixes_) blender.blend(mix.own, mix.other, mix.share);
    std::vector<Vec3f> before = mesh_.positions;
    std::copy(level_.mesh().positions.begin(), level_.mesh().positions.end(), before.begin());
    detail::carry_attributes(level_.target(), before, mesh_, task_);
    return {std::move(mesh_), std::move(pulled_)};
  }

 private:
  std::size_t split(std::uint32_t t, const TriangleError& worst, double way) {
    const Triangle v = mesh_.vertices_of(t);
    const double second = static_cast<double>(worst.second), third = static_cast<double>(worst.third);
    const double weights[3] = {1 - second - third, second, third};
    Vec3d at{};
    for (std::size_t k = 0; k < 3; ++k) at += mesh_.position(v[k]) * weights[k];
    const Vec3d move = (worst.partner - at) * way;
    for (std::size_t k = 0; k < 3; ++k) {
      if (weights[k] > 1 - kNearSide) return pull_in(v[k], move * kPull);
    }
    const auto corner = static_cast<std::size_t>(std::min_element(weights, weights + 3) - weights);
    const std::size_t next = (corner + 1) % 3, last = (corner + 2) % 3;
    if (weights[corner] > kNearSide) return split_face(t, worst, at + move);
    const double share = weights[last] / (weights[next] + weights[last]);
    const Vec3d on_side = lerp(mesh_.position(v[next]), mesh_.position(v[last]), share);
    return split_side(t, next, share, on_side + (worst.partner - on_side) * way);
  }

  bool may_split(const Edge& edge) const { return edge.count == 2 || (edge.count == 1 && !keep_borders_); }

  // Two triangles with the same wedges and material on both sides.
  bool is_smooth(const Edge& edge) const {
    if (edge.count != 2) return false;
    const auto around = edges_.of(edge);
    if (mesh_.group_of(around[0]) != mesh_.group_of(around[1])) return false;
    std::uint32_t wedge[2][2] = {};
    for (std::size_t i = 0; i < 2; ++i) {
      for (const std::uint32_t w : mesh_.triangles[around[i]]) {
        if (mesh_.vertex_of(w) == edge.a) wedge[i][0] = w;
        if (mesh_.vertex_of(w) == edge.b) wedge[i][1] = w;
      }
    }
    return wedge[0][0] == wedge[1][0] && wedge[0][1] == wedge[1][1];
  }

  Vec3d normal_of(const Triangle& wedges, std::uint32_t moved, Vec3d to) const {
    std::array<Vec3d, 3> p;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = mesh_.vertex_of(wedges[k]);
      p[k] = v == moved ? to : mesh_.position(v);
    }
    return scaled_normal(p[0], p[1], p[2]);
  }
  static bool looks_alike(Vec3d before, Vec3d after) {
    return dot(before, after) > kTurn * length(before) * length(after);
  }
  // Whether a triangle may be cut into those that have `place` for one of these corners each.
  bool may_cut(std::uint32_t t, std::initializer_list<std::size_t> corners, Vec3d place) {
    const Triangle v = mesh_.vertices_of(t);
    std::array<Vec3d, 3> p{mesh_.position(v[0]), mesh_.position(v[1]), mesh_.position(v[2])};
    const Vec3d before = scaled_normal(p[0], p[1], p[2]);
    for (const std::size_t k : corners) {
      std::array<Vec3d, 3> q = p;
      q[k] = place;
      if (!looks_alike(before, scaled_normal(q[0], q[1], q[2]))) return false;
      Triangle cut = v;
      cut[k] = kNone;
      if (crosses(cut, kNone, place)) return false;
    }
    return true;
  }

  // Which side of a triangle lies between two of its vertices: the one that the third is across.
  std::size_t side_between(std::uint32_t t, std::uint32_t a, std::uint32_t b) const {
    const Triangle v = mesh_.vertices_of(t);
    for (std::size_t k = 0; k < 2; ++k) {
      if (v[k] != a && v[k] != b) return (k + 1) % 3;
    }
    return 0;
  }

  // Whether a triangle with `moved` at `place` crosses one that has none of its vertices. Looks at the level as it was.
  bool crosses(const Triangle& v, std::uint32_t moved, Vec3d place) {
    std::array<Vec3d, 3> p;
    Box3d box;
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = v[k] == moved ? place : mesh_.position(v[k]);
      box.add(p[k]);
    }
    tree_.triangles_in(box, std::numeric_limits<std::size_t>::max(), near_);
    return std::any_of(near_.begin(), near_.end(), [&](std::uint32_t n) {
      const std::uint32_t t = tree_.surface().drawn[n];
      if (touched_[t] != 0) return false;
      const Triangle w = mesh_.vertices_of(t);
      const bool joined = std::any_of(w.begin(), w.end(), [&](auto x) { return x == v[0] || x == v[1] || x == v[2]; });
      return !joined && spatial::triangles_intersect(p, tree_.surface().corners(n));
    });
  }

  std::uint32_t add_vertex(Vec3d place) {
    const auto vertex = static_cast<std::uint32_t>(mesh_.positions.size());
    mesh_.positions.push_back(to_float(place - mesh_.offset));
    return vertex;
  }
  void add_triangle(const Triangle& wedges, std::uint32_t like) {
    mesh_.triangles.push_back(wedges);
    if (!mesh_.face_group.empty()) mesh_.face_group.push_back(mesh_.face_group[like]);
  }

  // Moves a vertex that sticks out.
  std::size_t pull_in(std::uint32_t vertex, Vec3d move) {
    if (no_move_[vertex] != 0) return 0;
    const Vec3d place = mesh_.position(vertex) + move;
    for (const std::uint32_t t : around_.of(vertex)) {
      const Triangle& w = mesh_.triangles[t];
      if (touched_[t] != 0 || !looks_alike(normal_of(w, kNone, {}), normal_of(w, vertex, place))) return 0;
      if (crosses(mesh_.vertices_of(t), vertex, place)) return 0;
    }
    for (const std::uint32_t t : around_.of(vertex)) touched_[t] = 1;
    mesh_.positions[vertex] = to_float(place - mesh_.offset);
    pulled_.push_back(vertex);
    return 1;
  }

  std::size_t split_face(std::uint32_t t, const TriangleError& worst, Vec3d place) {
    if (!may_cut(t, {0, 1, 2}, place)) return 0;
    touched_[t] = 1;
    const Triangle w = mesh_.triangles[t];
    const std::uint32_t wedge = add_wedge(mesh_, add_vertex(place), w[0]);
    const double second = static_cast<double>(worst.second), first_two = 1 - static_cast<double>(worst.third);
    mixes_.push_back({wedge, w[1], static_cast<float>(first_two > 0 ? second / first_two : 0)});
    mixes_.push_back({wedge, w[2], worst.third});
    mesh_.triangles[t] = {w[0], w[1], wedge};
    add_triangle({w[1], w[2], wedge}, t);
    add_triangle({w[2], w[0], wedge}, t);
    return 2;
  }

  // Side k of a triangle, at this share of the way to its end.
  std::size_t split_side(std::uint32_t t, std::size_t k, double share, Vec3d place) {
    const Triangle v = mesh_.vertices_of(t);
    const std::uint32_t begin = v[k], end = v[(k + 1) % 3];
    const auto [a, b] = std::minmax(begin, end);
    const auto found = std::lower_bound(edges_.edges.begin(), edges_.edges.end(), std::pair{a, b},
                                        [](const Edge& e, const auto& side) {
                                          return std::pair{e.a, e.b} < side;
                                        });
    if (found == edges_.edges.end() || found->a != a || found->b != b || !may_split(*found)) return 0;
    const auto around = edges_.of(*found);
    if (around.size() == 2 && around[0] == around[1]) return 0;
    for (const std::uint32_t u : around) {
      if (touched_[u] != 0) return 0;  // it may have been cut and have lost this side
      const std::size_t side = side_between(u, a, b);
      if (!may_cut(u, {side, (side + 1) % 3}, place)) return 0;
    }
    const std::uint32_t vertex = add_vertex(place);
    std::uint32_t made[2][3] = {};  // wedge, from, to
    std::size_t count = 0;
    for (const std::uint32_t u : around) {
      touched_[u] = 1;
      const Triangle w = mesh_.triangles[u];
      const std::size_t side = side_between(u, a, b);
      const std::uint32_t from = w[side], to = w[(side + 1) % 3], third = w[(side + 2) % 3];
      std::uint32_t wedge = kNone;
      for (std::size_t i = 0; i < count; ++i) {
        if (std::minmax(made[i][1], made[i][2]) == std::minmax(from, to)) wedge = made[i][0];
      }
      if (wedge == kNone) {
        wedge = add_wedge(mesh_, vertex, from);
        mixes_.push_back({wedge, to, static_cast<float>(mesh_.vertex_of(from) == begin ? share : 1 - share)});
        made[count][0] = wedge;
        made[count][1] = from;
        made[count++][2] = to;
      }
      mesh_.triangles[u] = {from, wedge, third};
      add_triangle({wedge, to, third}, u);
    }
    return around.size();
  }

  const TrackedLevel& level_;
  const Task& task_;
  bool keep_borders_;
  Mesh mesh_;
  EdgeTriangles edges_;  // of the level as it was
  VertexTriangles around_;
  spatial::Bvh tree_;  // of the level as it was
  std::vector<std::uint8_t> touched_;
  std::vector<std::uint8_t> no_move_;  // of the level's vertices
  std::vector<std::uint32_t> pulled_;
  std::vector<Mix> mixes_;
  std::vector<std::uint32_t> near_;
};

}  // namespace

SplitResult split_worst(const TrackedLevel& level, const SplitOptions& options, const Task& task) {
  const std::vector<TriangleError> worst = level.worst();
  std::vector<std::uint32_t> order;
  for (std::uint32_t t = 0; t < worst.size(); ++t) {
    if (static_cast<double>(worst[t].distance) > options.share * level.max()) order.push_back(t);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return worst[a].distance > worst[b].distance; });
  if (level.surface().triangles.empty()) return {level.mesh(), {}};
  Splitter splitter(level, options.keep_borders, options.no_move, task);
  if (task.cancelled()) return {level.mesh(), {}};
  for (std::uint32_t v = 0; v < options.no_split.size(); ++v) {
    if (options.no_split[v] != 0) splitter.leave_around(v);
  }
  std::size_t added = 0;
  for (const std::uint32_t t : order) {
    if (added >= options.most) break;
    added += splitter.split(t, worst[t]);
  }
  return splitter.finish();
}

}  // namespace lodestone::simplify
