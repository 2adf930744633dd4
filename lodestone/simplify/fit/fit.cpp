#include "lodestone/simplify/fit/fit.h"

#include <algorithm>

#include "lodestone/base/parallel.h"
#include "lodestone/core/adjacency.h"
#include "lodestone/math/triangle.h"
#include "lodestone/simplify/fit/attributes_detail.h"
#include "lodestone/simplify/fit/flip_detail.h"
#include "lodestone/simplify/fit/solve_detail.h"
#include "lodestone/simplify/fit/ties_detail.h"
#include "lodestone/simplify/fit/volume_detail.h"
#include "lodestone/spatial/closest_batch.h"
#include "lodestone/spatial/crossings.h"

namespace lodestone::simplify {

namespace {

// With colours or textures vertices hardly slide over the surface: collapses have put them where the texture's course
// is followed best.
constexpr double kDamping = 0.002, kDampingWithLook = 0.5;
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
detail::FixedSides fixed_sides(const Mesh& mesh, const Task& task) {
  detail::FixedSides fixed;
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
    if (!inner) fixed.emplace_back(edge.a, edge.b);
  }
  return fixed;
}

// Where each face that can move should look: as the original does at the point closest to its middle, or, where that
// looks away from it (the other side of something thin), as it looks now. Of length 1.
std::vector<Vec3d> facing_of(const FitTarget& target, const spatial::Surface& level,
                             const std::vector<std::uint8_t>& held, const Task& task) {
  std::vector<Vec3d> facing(level.triangles.size());
  parallel_for(facing.size(), 4096, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    std::vector<std::size_t> moving;
    std::vector<Vec3d> middles;
    for (std::size_t t = begin; t < end; ++t) {
      const Triangle& v = level.triangles[t];
      if (held[v[0]] != 0 && held[v[1]] != 0 && held[v[2]] != 0) continue;
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

bool has_look(const Mesh& mesh) {
  return std::any_of(mesh.attributes.begin(), mesh.attributes.end(), [](const AttributeStream& stream) {
    return stream.semantic == Semantic::uv || stream.semantic == Semantic::color;
  });
}

}  // namespace

struct FittedLevel::State {
  const FitTarget& target;
  Mesh mesh;
  detail::Known known;                     // the mesh's surface and its ties
  std::vector<std::uint32_t> mesh_vertex;  // of the surface's vertices

  State(const FitTarget& to, Mesh level, const Task& task, const detail::Known* before)
      : target(to), mesh(std::move(level)) {
    known.level = surface_of(mesh, task);
    known.ties = detail::make_ties(target, known.level, task, before);
    if (before == nullptr) detail::look_at_worst(target, known.level, suspect_share(target), known.ties, task);
    mesh_vertex = mesh_vertices(mesh, known.level);
  }
};

FittedLevel::FittedLevel(const FitTarget& target, Mesh level, const Task& task, const FittedLevel* known)
    : state_(std::make_unique<State>(target, std::move(level), task,
                                     known != nullptr ? &known->state_->known : nullptr)) {}
FittedLevel::FittedLevel(const FittedLevel& other) : state_(std::make_unique<State>(*other.state_)) {}
FittedLevel& FittedLevel::operator=(const FittedLevel& other) {
  state_ = std::make_unique<State>(*other.state_);
  return *this;
}
FittedLevel::FittedLevel(FittedLevel&&) noexcept = default;
FittedLevel& FittedLevel::operator=(FittedLevel&&) noexcept = default;
FittedLevel::~FittedLevel() = default;

const FitTarget& FittedLevel::target() const { return state_->target; }
const Mesh& FittedLevel::mesh() const { return state_->mesh; }
double FittedLevel::mean() const { return state_->known.ties.mean; }
double FittedLevel::max() const { return state_->known.ties.max; }

std::vector<FittedLevel::Worst> FittedLevel::worst() const {
  std::vector<Worst> out(state_->mesh.triangles.size());
  const detail::Known& known = state_->known;
  for (std::size_t t = 0; t < known.ties.worst.size(); ++t) {
    const detail::Worst& w = known.ties.worst[t];
    out[known.level.drawn[t]] = {static_cast<double>(w.distance), static_cast<double>(w.second),
                                 static_cast<double>(w.third), w.partner};
  }
  return out;
}

const spatial::Surface& FittedLevel::surface() const { return state_->known.level; }

FittedLevel::Faults FittedLevel::faults(const Task& task) const {
  const spatial::Surface& level = state_->known.level;
  Faults faults;
  faults.vertices.resize(state_->mesh.vertex_count(), 0);
  if (level.triangles.empty()) return faults;
  const auto crossings = spatial::crossings(spatial::Bvh(level, task), {}, task);
  const auto folds = spatial::folds(level);
  faults.crossings = crossings.size();
  faults.folds = folds.size();
  for (const auto* pairs : {&crossings, &folds}) {
    for (const auto& pair : *pairs) {
      for (const std::uint32_t t : pair) {
        for (const std::uint32_t v : level.triangles[t]) faults.vertices[state_->mesh_vertex[v]] = 1;
      }
    }
  }
  return faults;
}

void FittedLevel::look_at(Vec3d place, bool on_original, const Task& task) {
  detail::Known& known = state_->known;
  if (known.level.triangles.empty() || state_->target.surface().triangles.empty()) return;
  const spatial::Bvh tree(known.level, task);
  if (task.cancelled()) return;
  const spatial::Nearest on_level = tree.closest(place);
  const Vec3d partner = on_original ? place : state_->target.tree().closest(place).point;
  const auto [a, b, c] = known.level.corners(on_level.triangle);
  const std::array<double, 3> w = barycentric(on_level.point, a, b, c);
  const auto distance = static_cast<float>(length(partner - on_level.point));
  const detail::Worst found{distance, static_cast<float>(w[1]), static_cast<float>(w[2]), partner};
  detail::Worst& worst = known.ties.worst[on_level.triangle];
  if (found.distance > worst.distance) worst = found;
  known.ties.max = std::max(known.ties.max, static_cast<double>(distance));
  // What is kept of a triangle says that it was looked at closely.
  detail::look_at_worst(state_->target, known.level, suspect_share(state_->target), known.ties, task);
  detail::Worst& close = known.ties.close[on_level.triangle];
  if (found.distance > close.distance) close = found;
}

void FittedLevel::fit(const FitOptions& options, const Task& task) {
  Mesh& mesh = state_->mesh;
  detail::Known& known = state_->known;
  const FitTarget& target = state_->target;
  if (known.ties.list.empty()) return;
  std::vector<std::uint32_t> surface_vertex(mesh.vertex_count(), kNone);
  for (std::uint32_t v = 0; v < state_->mesh_vertex.size(); ++v) surface_vertex[state_->mesh_vertex[v]] = v;
  std::vector<std::uint8_t> held;
  for (const std::uint32_t v : state_->mesh_vertex) held.push_back(options.locked.empty() ? 0 : options.locked[v]);
  detail::FixedSides fixed;
  for (const auto& [a, b] : fixed_sides(mesh, task)) {
    const std::uint32_t x = surface_vertex[a], y = surface_vertex[b];
    if (x == kNone || y == kNone) continue;
    held[x] = held[y] = 1;
    fixed.emplace_back(std::min(x, y), std::max(x, y));
  }
  std::sort(fixed.begin(), fixed.end());
  if (task.cancelled()) return;
  std::vector<Triangle> wedges;
  for (const std::uint32_t t : known.level.drawn) wedges.push_back(mesh.triangles[t]);
  const bool flips = options.flips && !has_look(mesh);
  const double damping = has_look(mesh) ? kDampingWithLook : kDamping;
  std::vector<Vec3d> facing;
  if (options.solves > 0 || options.volume) facing = facing_of(target, known.level, held, task);
  for (int solve = 0; solve < options.solves && !task.cancelled(); ++solve) {
    detail::Known before = known;
    const std::vector<Triangle> wedges_before = wedges;
    if (flips && solve > 0) {
      const auto turned = detail::flip_edges(target, known.ties, fixed, held, known.level, wedges, task);
      for (const auto& [t, u] : turned) facing[t] = facing[u] = facing[t] + facing[u];
      detail::retie(target, known.level, turned, known.ties, task);
    }
    const detail::CornersAt around = detail::corners_at(known.level);
    std::vector<Vec3d> moves = detail::solve_moves(known.level, known.ties, around, held, damping, task);
    detail::take_moves(known.level, around, std::move(moves), facing, mesh.offset, task);
    known.ties = detail::make_ties(target, known.level, task, options.locked.empty() ? nullptr : &before);
    if (!(known.ties.energy < before.ties.energy)) {
      known = std::move(before);
      wedges = wedges_before;
      break;
    }
  }
  if (options.volume && !task.cancelled()) {
    std::vector<Vec3d> moves = detail::volume_moves(target.surface(), known.level, held);
    if (!moves.empty()) {
      detail::take_moves(known.level, detail::corners_at(known.level), std::move(moves), facing, mesh.offset, task);
      known.ties = detail::make_ties(target, known.level, task);
    }
  }
  detail::look_at_worst(target, known.level, suspect_share(target), known.ties, task);
  const std::vector<Vec3f> positions_before = mesh.positions;
  for (std::size_t v = 0; v < state_->mesh_vertex.size(); ++v) {
    if (held[v] == 0) mesh.positions[state_->mesh_vertex[v]] = to_float(known.level.positions[v] - mesh.offset);
  }
  for (std::size_t t = 0; t < wedges.size(); ++t) mesh.triangles[known.level.drawn[t]] = wedges[t];
  detail::carry_attributes(target, positions_before, mesh, task);
}

}  // namespace lodestone::simplify
