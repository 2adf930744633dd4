// The part of CollapsePlan that improves levels by their own measured error.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "lodestone/chain/ladder/collapse_plan_detail.h"
#include "lodestone/chain/ladder/feedback_detail.h"
#include "lodestone/math/triangle.h"

namespace lodestone::chain::detail {

namespace {

// A weighted run starts from a level of so many times the triangles: it is as good as the original there, and faster.
constexpr std::size_t kFiner = 6;

// Larger levels are not improved: correspondences take some 300 bytes a triangle, three times over.
constexpr std::size_t kMostTriangles = std::size_t{1} << 21;

// Distances in mesh space and in the scene differ by a factor alone.
bool is_similarity(const Mat4d& placing) {
  const Vec3d x = placing.direction({1, 0, 0}), y = placing.direction({0, 1, 0}), z = placing.direction({0, 0, 1});
  const double a = length_sq(x), b = length_sq(y), c = length_sq(z), slack = 1e-6 * a;
  return a > 0 && std::abs(a - b) <= slack && std::abs(a - c) <= slack && std::abs(dot(x, y)) <= slack &&
         std::abs(dot(y, z)) <= slack && std::abs(dot(z, x)) <= slack;
}

// Among thousands of slivers, long and almost without width, a closest point takes a thousand times as long.
bool has_many_slivers(const Mesh& mesh) {
  constexpr std::size_t kMany = 1000;
  constexpr double kLong = 0.01, kWidth = 1e-5;  // of the diagonal
  const double diagonal = bounds_of(mesh).diagonal();
  std::size_t count = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle v = mesh.vertices_of(t);
    const Vec3d p[3] = {mesh.position(v[0]), mesh.position(v[1]), mesh.position(v[2])};
    const double longest = std::max({length(p[1] - p[0]), length(p[2] - p[1]), length(p[0] - p[2])});
    if (longest <= kLong * diagonal) continue;
    count += length(scaled_normal(p[0], p[1], p[2])) < kWidth * diagonal * longest ? 1 : 0;
  }
  return count > kMany;
}

}  // namespace

bool CollapsePlan::can_take_feedback() const {
  for (std::size_t m = 0; m < logs_.size(); ++m) {
    if (can_take_feedback(m)) return true;
  }
  return false;
}

bool CollapsePlan::can_take_feedback(std::size_t m) const {
  return logs_[m].start_triangles > 0 && untouched_.empty() && !prunes_ && is_similarity(placings_[m]) &&
         std::isfinite(bounds_of(mesh(m)).diagonal()) && !has_many_slivers(mesh(m));
}

Result<Mesh> CollapsePlan::mesh_with_feedback(std::size_t m, NamedMesh plain, Effort effort, double goal,
                                              FitTargets& targets, const Task& task) const {
  const CollapseLog& log = logs_[m];
  const std::size_t triangles = plain.mesh.triangles.size();
  if (triangles == 0 || triangles >= log.start_triangles || triangles > kMostTriangles) {
    return std::move(plain.mesh);
  }
  targets.targets.resize(logs_.size());
  targets.references.resize(logs_.size());
  std::unique_ptr<simplify::FitTarget>& target = targets.targets[m];
  if (target == nullptr) target = std::make_unique<simplify::FitTarget>(mesh(m), task, effort == Effort::best);
  std::optional<measure::Reference>& reference = targets.references[m];
  if (goal > 0 && !reference) {
    Result<measure::Reference> made = measure::Reference::create(make_model(mesh(m)), task);
    LODESTONE_TRY(made);
    reference = std::move(*made);
  }
  const simplify::EdgeCollapseOptions& options = options_[m];
  ReplayResult finer;
  const bool weighs = !options.weights.empty();  // weights are about the vertices of the original
  if (!weighs && kFiner * triangles < log.start_triangles) {
    ReplayOptions of_valid;
    of_valid.input = Input::valid;
    Result<ReplayResult> replayed = replay(mesh(m), log, log.prefix_for(kFiner * triangles), of_valid, task);
    LODESTONE_TRY(replayed);
    finer = std::move(*replayed);
  }
  const double scale = length(placings_[m].direction({1, 0, 0}));
  std::vector<std::uint32_t> names = std::move(finer.vertex_origin);
  if (finer.mesh.triangles.empty()) {
    names.resize(mesh(m).vertex_count());
    std::iota(names.begin(), names.end(), 0U);
  }
  const FeedbackSource source{finer.mesh.triangles.empty() ? mesh(m) : finer.mesh,
                              *target,
                              std::move(names),
                              options,
                              goal / scale,
                              reference ? &*reference : nullptr};
  Result<Mesh> made = apply_feedback(source, std::move(plain), effort, task);
  if (made) finish(*made);
  return made;
}

Result<Model> CollapsePlan::model_with_feedback(std::size_t count, Effort effort, double goal, FitTargets& targets,
                                                Task task) const {
  std::vector<std::vector<std::uint32_t>> vertex_origins;
  Result<Model> model = replayed(count, vertex_origins, task.part(0.1));
  if (!model || effort == Effort::fast) return model;
  const double share = 0.9 / static_cast<double>(std::max<std::size_t>(1, logs_.size()));
  for (std::size_t m = 0; m < logs_.size(); ++m) {
    if (!can_take_feedback(m)) continue;
    Result<Mesh> made = mesh_with_feedback(m, {std::move(model->meshes[m]), std::move(vertex_origins[m])}, effort, goal,
                                           targets, task.part(share));
    LODESTONE_TRY(made);
    model->meshes[m] = std::move(*made);
  }
  return model;
}

}  // namespace lodestone::chain::detail
