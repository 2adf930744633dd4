// One order of steps for a whole model, from which every level is a prefix (after [progressive-mesh], section 2.2).
//
// 1. create() collects what the constraints say of each mesh. Where it is asked for, working_meshes() welds near
//    vertices or joins near parts first.
// 2. plan_mesh() collapses each drawn mesh once, as far as the smallest level may need. Its log holds the steps with
//    their errors in world space. Where parts may vanish, simplify::prune_order() adds steps for them.
// 3. merge() puts the steps of all meshes in order of error. Within a mesh errors never fall, so a stable sort leaves
//    the mesh's own order as it is.
// 4. count_triangles() adds up how many triangles are drawn after each prefix; a mesh counts once for each instance.
//    prefix_for() then finds the prefix for a count by bisection.
// 5. model_after() makes a level: mesh_after() replays each mesh's share of the prefix, leaves out the parts that have
//    vanished, and lets others grow by their area; finish() does tangents and skin weights.
// 6. end() says in plain words why no step follows the last.
//
// The original is never changed. The same steps for any number of threads. O(n log n) for the plan, O(n) for a level.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "lodestone/base/units.h"
#include "lodestone/chain/ladder/collapse_plan_detail.h"
#include "lodestone/chain/ladder/working_meshes_detail.h"
#include "lodestone/core/adjacency.h"
#include "lodestone/core/parts.h"
#include "lodestone/core/skin.h"
#include "lodestone/core/tangents.h"
#include "lodestone/simplify/prune/grow_parts.h"

namespace lodestone::chain::detail {

namespace {

void add(simplify::LockCounts& sum, const simplify::LockCounts& more) {
  sum.border += more.border;
  sum.seam_corner += more.seam_corner;
  sum.non_manifold += more.non_manifold;
  sum.by_request += more.by_request;
}

void lock_borders(const Mesh& mesh, std::vector<std::uint8_t>& no_move, const Task& task) {
  no_move.resize(mesh.vertex_count(), 0);
  for (const Edge& edge : edge_triangles(mesh, task).edges) {
    if (edge.count == 1) no_move[edge.a] = no_move[edge.b] = 1;
  }
}

}  // namespace

Result<CollapsePlan> CollapsePlan::create(const Model& original, std::size_t smallest,
                                          const SimplifyConstraints& constraints, Task task) {
  CollapsePlan plan;
  plan.original_ = &original;
  plan.uses_ = instance_counts(original);
  plan.placings_ = largest_placings(original);
  plan.prunes_ = constraints.vanishes();
  plan.keep_area_ = constraints.keep_area;
  plan.max_skin_influences_ = constraints.max_skin_influences;
  plan.tangents_ = constraints.tangents;
  Result<std::vector<std::vector<std::uint8_t>>> untouched = untouched_triangles(original, constraints);
  LODESTONE_TRY(untouched);
  plan.untouched_ = std::move(*untouched);
  Model working;  // what the constraints are about
  working.instances = original.instances;
  Result<std::vector<Mesh>> meshes = working_meshes(original, plan.placings_, constraints, plan.untouched_, task);
  LODESTONE_TRY(meshes);
  working.meshes = std::move(*meshes);
  Result<std::vector<VertexConstraints>> told =
      vertex_constraints(working.meshes.empty() ? original : working, constraints);
  LODESTONE_TRY(told);
  plan.working_ = std::move(working.meshes);
  plan.options_.resize(original.meshes.size());
  plan.logs_.resize(original.meshes.size());
  plan.thin_.resize(original.meshes.size());
  const std::size_t all = std::max<std::size_t>(1, drawn_triangles(original));
  const std::size_t target = original.instances.size() == 1 ? std::max<std::size_t>(1, smallest) : 1;
  for (std::size_t m = 0; m < original.meshes.size(); ++m) {
    const std::size_t triangles = plan.mesh(m).triangles.size();
    if (plan.uses_[m] == 0 || triangles == 0) continue;
    const double share = static_cast<double>(triangles * plan.uses_[m]) / static_cast<double>(all);
    LODESTONE_TRY(plan.plan_mesh(m, target, constraints, std::move((*told)[m]), task.part(share)));
  }
  plan.merge();
  plan.count_triangles();
  return plan;
}

Result<void> CollapsePlan::plan_mesh(std::size_t m, std::size_t target, const SimplifyConstraints& constraints,
                                     VertexConstraints told, const Task& task) {
  simplify::EdgeCollapseOptions& options = options_[m];
  options.target_triangles = target;
  options.keep_border = constraints.keep_border;
  options.weights = std::move(told.weights);
  options.no_move = std::move(told.no_move);
  options.attribute_weights = constraints.attribute_weights;
  options.metric = placings_[m];
  options.record_log = true;
  options.input = Input::valid;
  Result<simplify::EdgeCollapseResult> run =
      simplify::collapse_edges(mesh(m), options, constraints.vanishes() ? task.part(0.7) : task);
  LODESTONE_TRY(run);
  logs_[m] = std::move(*run->log);
  add(locked_, run->locked);
  if (!constraints.vanishes()) return {};
  simplify::PruneOptions thin;
  thin.keep_area = constraints.keep_area;
  thin.weights = options.weights;
  thin.no_move = options.no_move;
  if (constraints.keep_border) lock_borders(mesh(m), thin.no_move, task);
  thin.left_out = logs_[m].dropped;
  thin.metric = placings_[m];
  thin.input = Input::valid;
  Result<simplify::PruneOrder> parts = simplify::prune_order(mesh(m), thin, task.part(0.3));
  LODESTONE_TRY(parts);
  thin_[m] = std::move(*parts);
  return {};
}

// All meshes' steps by error in world space; within a mesh its own order, as its errors never fall.
void CollapsePlan::merge() {
  struct Entry {
    float error;
    Step step;
  };
  std::vector<Entry> entries;
  std::size_t total = 0;
  for (std::size_t m = 0; m < logs_.size(); ++m) total += logs_[m].collapses.size() + thin_[m].steps.size();
  entries.reserve(total);
  std::size_t lists = 0;
  for (std::uint32_t m = 0; m < logs_.size(); ++m) {
    for (const Collapse& c : logs_[m].collapses) entries.push_back({c.error, {m, false}});
    for (const simplify::PruneStep& v : thin_[m].steps) entries.push_back({v.error, {m, true}});
    lists += (logs_[m].collapses.empty() ? 0 : 1) + (thin_[m].steps.empty() ? 0 : 1);
  }
  if (lists > 1) {
    std::stable_sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.error < b.error; });
  }
  steps_.reserve(entries.size());
  for (const Entry& entry : entries) steps_.push_back(entry.step);
}

// A part that vanishes takes the triangles along that it still has; later collapses in it remove none.
void CollapsePlan::count_triangles() {
  std::size_t drawn = 0;
  std::vector<std::vector<std::uint32_t>> left(logs_.size());  // triangles of each part
  for (std::size_t m = 0; m < logs_.size(); ++m) {
    drawn += std::size_t{logs_[m].start_triangles} * uses_[m];
    if (!untouched_.empty()) {
      for (const std::uint32_t t : logs_[m].dropped) drawn += untouched_[m][t] != 0 ? uses_[m] : 0;
    }
    if (thin_[m].steps.empty()) continue;
    left[m].assign(thin_[m].parts.count, 0);
    std::size_t next = 0;
    const std::vector<std::uint32_t>& dropped = logs_[m].dropped;
    for (std::size_t t = 0; t < mesh(m).triangles.size(); ++t) {
      if (next < dropped.size() && dropped[next] == t) {
        ++next;
      } else {
        ++left[m][thin_[m].parts.of_triangle(mesh(m), t)];
      }
    }
  }
  drawn_after_.reserve(size() + 1);
  drawn_after_.push_back(drawn);
  std::vector<Progress> at(logs_.size());
  for (const Step& step : steps_) {
    const std::size_t m = step.mesh();
    std::uint32_t faces = 0;
    if (step.vanishes()) {
      faces = std::exchange(left[m][thin_[m].steps[at[m].steps++].part], 0);
    } else {
      const Collapse& c = logs_[m].collapses[at[m].collapses++];
      faces = c.faces;
      if (!left[m].empty()) {
        std::uint32_t& rest = left[m][thin_[m].parts.of_vertex[c.kept]];
        faces = std::min(faces, rest);
        rest -= faces;
      }
    }
    drawn -= std::size_t{faces} * uses_[m];
    drawn_after_.push_back(drawn);
  }
}

std::size_t CollapsePlan::prefix_for(std::size_t triangles) const {
  const auto found = std::partition_point(drawn_after_.begin(), drawn_after_.end(),
                                          [&](std::size_t left) { return left > triangles; });
  return std::min(size(), static_cast<std::size_t>(found - drawn_after_.begin()));
}

std::size_t CollapsePlan::vanished_after(std::size_t count) const {
  std::size_t vanished = 0;
  for (std::size_t i = 0; i < count; ++i) vanished += steps_[i].vanishes() ? uses_[steps_[i].mesh()] : 0;
  return vanished;
}

std::vector<CollapsePlan::Progress> CollapsePlan::progress_after(std::size_t count) const {
  std::vector<Progress> at(logs_.size());
  for (std::size_t i = 0; i < count; ++i) {
    Progress& p = at[steps_[i].mesh()];
    ++(steps_[i].vanishes() ? p.steps : p.collapses);
  }
  return at;
}

Result<Model> CollapsePlan::model_after(std::size_t count, Task task) const {
  std::vector<std::vector<std::uint32_t>> vertex_origins;
  return replayed(count, vertex_origins, task);
}

Result<Model> CollapsePlan::replayed(std::size_t count, std::vector<std::vector<std::uint32_t>>& vertex_origins,
                                     const Task& task) const {
  const std::vector<Progress> at = progress_after(count);
  double error = 0;  // the largest of the prefix: its last step's
  if (count > 0) {
    const Step last = steps_[count - 1];
    error = last.vanishes() ? thin_[last.mesh()].steps[at[last.mesh()].steps - 1].error
                            : logs_[last.mesh()].collapses[at[last.mesh()].collapses - 1].error;
  }
  Model model;
  model.instances = original_->instances;
  model.materials = original_->materials;
  model.document = original_->document;
  model.meters_per_unit = original_->meters_per_unit;
  model.gltf_axes = original_->gltf_axes;
  model.uv_origin_top = original_->uv_origin_top;
  const double share = 1.0 / static_cast<double>(std::max<std::size_t>(1, logs_.size()));
  vertex_origins.assign(logs_.size(), {});
  for (std::size_t m = 0; m < logs_.size(); ++m) {
    if (logs_[m].start_triangles == 0) {  // not drawn: as it was
      model.meshes.push_back(original_->meshes[m]);
      continue;
    }
    Result<ReplayResult> made = mesh_after(m, at[m], error, task.part(share));
    LODESTONE_TRY(made);
    model.meshes.push_back(std::move(made->mesh));
    vertex_origins[m] = std::move(made->vertex_origin);
  }
  return model;
}

Result<ReplayResult> CollapsePlan::mesh_after(std::size_t m, const Progress& progress, double error,
                                              const Task& task) const {
  const simplify::PruneOrder& thin = thin_[m];
  ReplayOptions options;
  options.input = Input::valid;
  if (!untouched_.empty()) options.untouched = untouched_[m];
  std::vector<double> area = thin.area;  // that each part stands for
  if (progress.steps > 0) {
    std::vector<std::uint8_t> gone(thin.parts.count, 0);
    for (std::size_t i = 0; i < progress.steps; ++i) {
      const simplify::PruneStep& v = thin.steps[i];
      gone[v.part] = 1;
      area[v.absorber] += area[v.part];
    }
    options.left_out.resize(mesh(m).triangles.size(), 0);
    for (std::size_t t = 0; t < options.left_out.size(); ++t) {
      const std::uint32_t part = thin.parts.of_triangle(mesh(m), t);
      options.left_out[t] = part != kNone ? gone[part] : 0;
    }
  }
  Result<ReplayResult> out = replay(mesh(m), logs_[m], progress.collapses, options, task);
  LODESTONE_TRY(out);
  if (keep_area_) {
    simplify::grow_parts(mesh(m), thin, {area, error, placings_[m]}, out->origin, out->mesh);
  }
  if (options.untouched.empty()) finish(out->mesh);
  return out;
}

void CollapsePlan::finish(Mesh& mesh) const {
  if (tangents_ == Tangents::dropped) drop_tangents(mesh);
  if (tangents_ == Tangents::rebuilt) rebuild_tangents(mesh);
  if (max_skin_influences_ > 0) limit_influences(mesh, max_skin_influences_);
}

// Parts drawn when nothing vanishes, of meshes that have several: of a mesh of one part none could vanish.
std::size_t CollapsePlan::drawn_parts() const {
  std::size_t parts = 0;
  for (std::size_t m = 0; m < logs_.size(); ++m) {
    const std::size_t count = logs_[m].start_triangles > 0 ? parts_of(mesh(m)).count : 0;
    if (count > 1) parts += count * uses_[m];
  }
  return parts;
}

PlanEnd CollapsePlan::end() const {
  std::vector<std::string> causes;
  const auto tell = [&](std::size_t count, const char* text) {
    if (count > 0) causes.push_back(fmt::format("{} {}", with_separators(count), text));
  };
  tell(locked_.seam_corner,
       "where seams, borders or materials meet or end (`weld_tolerance`, or unwrap the model anew, to free them)");
  tell(locked_.non_manifold,
       "non-manifold (`weld_tolerance` may close cracks; else split the model into clean pieces)");
  tell(locked_.border, "on open borders (leave `keep_border` off to free them)");
  tell(locked_.by_request, "locked on request");
  std::string why = causes.empty() ? "no collapse is left that keeps the surface's topology and folds nothing"
                                   : fmt::format("vertices that cannot move: {}", fmt::join(causes, ", "));
  // A part never loses its last triangle, or four where it is closed: where these are many of all, they are the cause.
  constexpr std::size_t kMany = 16;
  if (prunes_) return {why};
  const std::size_t parts = drawn_parts();
  if (parts < 2 || parts * kMany < triangles_after(size())) return {why};
  why += fmt::format(
      "; {} separate parts keep a few triangles each (`prune` lets small ones vanish; of a mesh, `join_length` "
      "LENGTH sews near ones together)",
      with_separators(parts));
  return {why, parts};
}

}  // namespace lodestone::chain::detail
