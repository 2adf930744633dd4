// A level that knows how far it is from its original, and can be fitted to it ([hoppe-1993], with distances both ways).
//
// The constructor finds all correspondences (find_correspondences()) and looks closely where the error is largest
// (probe_worst_errors()). With a known level, only what differs from it is looked for. mean(), max() and worst() say
// what was found; faults() counts triangles that cross or fold; probe_error() takes in a place where somebody else has
// measured more.
//
// fit() repeats, `solves` times at most:
// 1. flip_edges(), from the second time on, and not with textures or colours;
// 2. solve_displacements() and apply_displacements(): vertices moved to where squared distances are least;
// 3. find_correspondences() again. If the sum of squares has not fallen, the round is taken back and ends the loop.
// Then, where asked for, one move along the normals restores the volume (volume_moves()), and attributes follow the
// moved vertices (carry_attributes()).
//
// Vertices of borders, seams, borders of materials and non-manifold edges (fixed_sides()) do not move, nor do those of
// FitOptions::no_move. The same bytes for any number of threads. O(solves * n log n).
#include "lodestone/simplify/fit/tracked_level.h"

#include <algorithm>

#include "lodestone/base/parallel.h"
#include "lodestone/core/adjacency.h"
#include "lodestone/math/triangle.h"
#include "lodestone/simplify/fit/attributes_detail.h"
#include "lodestone/simplify/fit/correspondences_detail.h"
#include "lodestone/simplify/fit/flip_detail.h"
#include "lodestone/simplify/fit/solve_detail.h"
#include "lodestone/simplify/fit/volume_detail.h"
#include "lodestone/spatial/closest_batch.h"
#include "lodestone/spatial/self_intersections.h"

namespace lodestone::simplify {

namespace {

// With colours or textures vertices must hardly slide over the surface: collapses have put them where they follow the
// texture best.
constexpr double kDamping = 0.002, kDampingWithAppearance = 0.5;
// Of the maximum: triangles above it are looked at closely.
constexpr double kSuspect = 0.4, kSuspectRoughly = 0.65;

double suspect_share(const FitTarget& target) { return target.has_centres() ? kSuspect : kSuspectRoughly; }

// For each vertex of the surface, that of the mesh.
std::vector<std::uint32_t> mesh_vertices(const Mesh& mesh, const spatial::Surface& surface) {
  std::vector<std::uint32_t> of(surface.positions.size(), kNone);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const Triangle own = mesh.vertices_of(surface.drawn[t]);
    for (std::size_t k = 0; k < 3; ++k) of[surface.triangles[t][k]] = own[k];
  }
  return of;
}

// Sides that do not join exactly two triangles the same way, with the same wedges and material; vertices of the mesh.
detail::NoFlipEdges fixed_sides(const Mesh& mesh, const Task& task) {
  detail::NoFlipEdges no_flip;
  const EdgeTriangles edges = edge_triangles(mesh, task);
  for (const Edge& edge : edges.edges) {
    bool inner = edge.count == 2;
    if (inner) {
      const auto around = edges.of(edge);
      inner = mesh.group_of(around[0]) == mesh.group_of(around[1]);
      // The wedges at both ends, and which way each triangle walks the edge.
      std::uint32_t wedge[2][2] = {};
      bool forward[2] = {};
      for (std::size_t i = 0; i < 2; ++i) {
        const Triangle& w = mesh.triangles[around[i]];
        for (std::size_t k = 0; k < 3; ++k) {
          if (mesh.vertex_of(w[k]) == edge.a) {
            wedge[i][0] = w[k];
            forward[i] = mesh.vertex_of(w[(k + 1) % 3]) == edge.b;
          }
          if (mesh.vertex_of(w[k]) == edge.b) wedge[i][1] = w[k];
        }
      }
      inner = inner && wedge[0][0] == wedge[1][0] && wedge[0][1] == wedge[1][1] && forward[0] != forward[1];
    }
    if (!inner) no_flip.emplace_back(edge.a, edge.b);
  }
  return no_flip;
}

// Where each face that can move should look: as the original does at the point closest to its middle, or, where that
// looks away from it (the other side of something thin), as it looks now. Of length 1.
std::vector<Vec3d> facing_of(const FitTarget& target, const spatial::Surface& level,
                             const std::vector<std::uint8_t>& no_move, const Task& task) {
  std::vector<Vec3d> facing(level.triangles.size());
  parallel_for(facing.size(), 4096, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    std::vector<std::size_t> moving;
    std::vector<Vec3d> middles;
    for (std::size_t t = begin; t < end; ++t) {
      const Triangle& v = level.triangles[t];
      if (no_move[v[0]] != 0 && no_move[v[1]] != 0 && no_move[v[2]] != 0) continue;
      const auto [a, b, c] = level.corners(t);
      moving.push_back(t);
      middles.push_back((a + b + c) / 3.0);
    }
    std::vector<spatial::Nearest> closest(middles.size());
    spatial::ClosestBatch(target.tree()).find(middles, closest);
    for (std::size_t i = 0; i < moving.size(); ++i) {
      const auto [a, b, c] = level.corners(moving[i]);
      const auto [x, y, z] = target.surface().corners(closest[i].triangle);
      const Vec3d own = normalized(scaled_normal(a, b, c)), theirs = normalized(scaled_normal(x, y, z));
      facing[moving[i]] = dot(own, theirs) > 0 ? theirs : own;
    }
  });
  return facing;
}

bool has_appearance(const Mesh& mesh) {
  return std::any_of(mesh.attributes.begin(), mesh.attributes.end(), [](const AttributeStream& stream) {
    return stream.semantic == Semantic::uv || stream.semantic == Semantic::color;
  });
}

}  // namespace

struct TrackedLevel::State {
  const FitTarget& target;
  Mesh mesh;
  detail::Known known;                     // the mesh's surface and its correspondences
  std::vector<std::uint32_t> mesh_vertex;  // of the surface's vertices

  State(const FitTarget& to, Mesh level, const Task& task, const detail::Known* before)
      : target(to), mesh(std::move(level)) {
    known.level = surface_of(mesh, task);
    known.correspondences = detail::find_correspondences(target, known.level, task, before);
    if (before == nullptr)
      detail::probe_worst_errors(target, known.level, suspect_share(target), known.correspondences, task);
    mesh_vertex = mesh_vertices(mesh, known.level);
  }
};

TrackedLevel::TrackedLevel(const FitTarget& target, Mesh level, const Task& task)
    : state_(std::make_unique<State>(target, std::move(level), task, nullptr)) {}
TrackedLevel::TrackedLevel(const FitTarget& target, Mesh level, const TrackedLevel& known, const Task& task)
    : state_(std::make_unique<State>(target, std::move(level), task, &known.state_->known)) {}
TrackedLevel::TrackedLevel(const TrackedLevel& other) : state_(std::make_unique<State>(*other.state_)) {}
TrackedLevel& TrackedLevel::operator=(const TrackedLevel& other) {
  state_ = std::make_unique<State>(*other.state_);
  return *this;
}
TrackedLevel::TrackedLevel(TrackedLevel&&) noexcept = default;
TrackedLevel& TrackedLevel::operator=(TrackedLevel&&) noexcept = default;
TrackedLevel::~TrackedLevel() = default;

const FitTarget& TrackedLevel::target() const { return state_->target; }
const Mesh& TrackedLevel::mesh() const { return state_->mesh; }
double TrackedLevel::mean() const { return state_->known.correspondences.mean; }
double TrackedLevel::max() const { return state_->known.correspondences.max; }

std::vector<TriangleError> TrackedLevel::worst() const {
  std::vector<TriangleError> out(state_->mesh.triangles.size());
  const detail::Known& known = state_->known;
  for (std::size_t t = 0; t < known.correspondences.worst.size(); ++t) {
    out[known.level.drawn[t]] = known.correspondences.worst[t];
  }
  return out;
}

const spatial::Surface& TrackedLevel::surface() const { return state_->known.level; }

TrackedLevel::Faults TrackedLevel::faults(const Task& task) const {
  const spatial::Surface& level = state_->known.level;
  Faults faults;
  faults.vertices.resize(state_->mesh.vertex_count(), 0);
  if (level.triangles.empty()) return faults;
  const auto intersections = spatial::self_intersections(spatial::Bvh(level, task), {}, task);
  const auto folds = spatial::folds(level);
  faults.intersections = intersections.size();
  faults.folds = folds.size();
  for (const auto* pairs : {&intersections, &folds}) {
    for (const auto& pair : *pairs) {
      for (const std::uint32_t t : pair) {
        for (const std::uint32_t v : level.triangles[t]) faults.vertices[state_->mesh_vertex[v]] = 1;
      }
    }
  }
  return faults;
}

void TrackedLevel::probe_error(Vec3d place, bool on_original, const Task& task) {
  detail::Known& known = state_->known;
  if (known.level.triangles.empty() || state_->target.surface().triangles.empty()) return;
  const spatial::Bvh tree(known.level, task);
  if (task.cancelled()) return;
  const spatial::Nearest on_level = tree.closest(place);
  const Vec3d partner = on_original ? place : state_->target.tree().closest(place).point;
  const auto [a, b, c] = known.level.corners(on_level.triangle);
  const std::array<double, 3> w = barycentric(on_level.point, a, b, c);
  const auto distance = static_cast<float>(length(partner - on_level.point));
  const TriangleError found{distance, static_cast<float>(w[1]), static_cast<float>(w[2]), partner};
  TriangleError& worst = known.correspondences.worst[on_level.triangle];
  if (found.distance > worst.distance) worst = found;
  known.correspondences.max = std::max(known.correspondences.max, static_cast<double>(distance));
  // This comes first: a triangle with an entry in `close` counts as looked at closely.
  detail::probe_worst_errors(state_->target, known.level, suspect_share(state_->target), known.correspondences, task);
  TriangleError& close = known.correspondences.close[on_level.triangle];
  if (found.distance > close.distance) close = found;
}

void TrackedLevel::fit(const FitOptions& options, const Task& task) {
  Mesh& mesh = state_->mesh;
  detail::Known& known = state_->known;
  const FitTarget& target = state_->target;
  if (known.correspondences.list.empty()) return;
  std::vector<std::uint32_t> surface_vertex(mesh.vertex_count(), kNone);
  for (std::uint32_t v = 0; v < state_->mesh_vertex.size(); ++v) surface_vertex[state_->mesh_vertex[v]] = v;
  std::vector<std::uint8_t> no_move;
  for (const std::uint32_t v : state_->mesh_vertex) no_move.push_back(options.no_move.empty() ? 0 : options.no_move[v]);
  detail::NoFlipEdges no_flip;
  for (const auto& [a, b] : fixed_sides(mesh, task)) {
    const std::uint32_t x = surface_vertex[a], y = surface_vertex[b];
    if (x == kNone || y == kNone) continue;
    no_move[x] = no_move[y] = 1;
    no_flip.emplace_back(std::min(x, y), std::max(x, y));
  }
  std::sort(no_flip.begin(), no_flip.end());
  if (task.cancelled()) return;
  std::vector<Triangle> wedges;
  for (const std::uint32_t t : known.level.drawn) wedges.push_back(mesh.triangles[t]);
  const bool flips = options.flips && !has_appearance(mesh);
  const double damping = has_appearance(mesh) ? kDampingWithAppearance : kDamping;
  std::vector<Vec3d> facing;
  if (options.solves > 0 || options.volume) facing = facing_of(target, known.level, no_move, task);
  for (int solve = 0; solve < options.solves && !task.cancelled(); ++solve) {
    detail::Known before = known;
    const std::vector<Triangle> wedges_before = wedges;
    if (flips && solve > 0) {
      const auto turned =
          detail::flip_edges(target, known.correspondences, no_flip, no_move, known.level, wedges, task);
      for (const auto& [t, u] : turned) facing[t] = facing[u] = facing[t] + facing[u];
      detail::update_correspondences(target, known.level, turned, known.correspondences, task);
    }
    const detail::CornersAt around = detail::corners_at(known.level);
    std::vector<Vec3d> moves =
        detail::solve_displacements(known.level, known.correspondences, around, no_move, damping, task);
    detail::apply_displacements(known.level, around, std::move(moves), facing, mesh.offset, task);
    known.correspondences =
        detail::find_correspondences(target, known.level, task, options.no_move.empty() ? nullptr : &before);
    if (!(known.correspondences.energy < before.correspondences.energy)) {
      known = std::move(before);
      wedges = wedges_before;
      break;
    }
  }
  if (options.volume && !task.cancelled()) {
    std::vector<Vec3d> moves = detail::volume_moves(target.surface(), known.level, no_move);
    if (!moves.empty()) {
      detail::apply_displacements(known.level, detail::corners_at(known.level), std::move(moves), facing, mesh.offset,
                                  task);
      known.correspondences = detail::find_correspondences(target, known.level, task);
    }
  }
  detail::probe_worst_errors(target, known.level, suspect_share(target), known.correspondences, task);
  const std::vector<Vec3f> positions_before = mesh.positions;
  for (std::size_t v = 0; v < state_->mesh_vertex.size(); ++v) {
    if (no_move[v] == 0) mesh.positions[state_->mesh_vertex[v]] = to_float(known.level.positions[v] - mesh.offset);
  }
  for (std::size_t t = 0; t < wedges.size(); ++t) mesh.triangles[known.level.drawn[t]] = wedges[t];
  detail::carry_attributes(target, positions_before, mesh, task);
}

}  // namespace lodestone::simplify
