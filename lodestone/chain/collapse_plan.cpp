#include <fmt/format.h>

#include <algorithm>

#include "lodestone/base/units.h"
#include "lodestone/chain/collapse_plan_detail.h"
#include "lodestone/core/weld.h"
#include "lodestone/spatial/snap.h"

namespace lodestone::chain::detail {

namespace {

// The placing of each mesh that shows its errors largest: in its space the mesh is simplified, and its errors are the
// scene's.
std::vector<Mat4d> largest_placings(const Model& model) {
  std::vector<Mat4d> placings(model.meshes.size());
  std::vector<double> scales(model.meshes.size(), 0);
  for (const Instance& i : model.instances) {
    const double scale = i.transform.scale_bound();
    if (scale <= scales[i.mesh]) continue;
    scales[i.mesh] = scale;
    placings[i.mesh] = i.transform.linear();
  }
  return placings;
}

// All meshes' collapses by error in world space; within a mesh the log's order, as its errors never fall.
std::vector<std::uint32_t> merge_order(const std::vector<CollapseLog>& logs) {
  struct Step {
    float error;
    std::uint32_t mesh;
  };
  std::vector<Step> steps;
  std::size_t total = 0;
  for (const CollapseLog& log : logs) total += log.collapses.size();
  steps.reserve(total);
  for (std::uint32_t m = 0; m < logs.size(); ++m) {
    for (const Collapse& c : logs[m].collapses) steps.push_back({c.error, m});
  }
  const bool one_mesh = steps.empty() || steps.front().mesh == steps.back().mesh;
  if (!one_mesh) {
    std::stable_sort(steps.begin(), steps.end(), [](const Step& a, const Step& b) { return a.error < b.error; });
  }
  std::vector<std::uint32_t> order(steps.size());
  for (std::size_t i = 0; i < steps.size(); ++i) order[i] = steps[i].mesh;
  return order;
}

// The meshes with near vertices joined. A tolerance in the scene is smaller in a mesh that is drawn larger.
Result<std::vector<Mesh>> weld_near(const Model& model, const std::vector<Mat4d>& placings, double tolerance,
                                    const Task& task) {
  std::vector<Mesh> out = model.meshes;
  for (std::size_t m = 0; m < out.size(); ++m) {
    const double scale = placings[m].scale_bound();
    const Result<std::size_t> moved =
        spatial::snap_positions(out[m].positions, scale > 0 ? tolerance / scale : tolerance, task);
    if (!moved) return fail(moved.error());
    Result<Mesh> welded = weld_exact(std::move(out[m]), task);
    if (!welded) return fail(welded.error());
    out[m] = std::move(*welded);
  }
  return out;
}

void add(simplify::LockCounts& sum, const simplify::LockCounts& more) {
  sum.border += more.border;
  sum.seam_corner += more.seam_corner;
  sum.non_manifold += more.non_manifold;
  sum.by_request += more.by_request;
}

}  // namespace

Result<CollapsePlan> CollapsePlan::create(const Model& original, std::size_t smallest, const Influence& influence,
                                          Task task) {
  CollapsePlan plan;
  plan.original_ = &original;
  const std::vector<std::uint32_t> uses = instance_counts(original);
  const std::size_t all = std::max<std::size_t>(1, drawn_triangles(original));
  const bool one_mesh = original.instances.size() == 1;
  const std::vector<Mat4d> placings = largest_placings(original);
  Model working;  // what the influences are about
  working.instances = original.instances;
  if (influence.weld_tolerance > 0) {
    Result<std::vector<Mesh>> welded = weld_near(original, placings, influence.weld_tolerance, task);
    if (!welded) return fail(welded.error());
    working.meshes = std::move(*welded);
  }
  Result<std::vector<VertexInfluence>> influences =
      vertex_influences(influence.weld_tolerance > 0 ? working : original, influence);
  if (!influences) return fail(influences.error());
  plan.welded_ = std::move(working.meshes);
  plan.logs_.resize(original.meshes.size());
  std::size_t drawn = 0;
  for (std::size_t m = 0; m < original.meshes.size(); ++m) {
    const Mesh& mesh = plan.mesh(m);
    if (uses[m] == 0 || mesh.triangles.empty()) continue;
    simplify::EdgeCollapseOptions options;
    options.target_triangles = one_mesh ? std::max<std::size_t>(1, smallest) : 1;
    options.keep_border = influence.keep_border;
    options.weights = std::move((*influences)[m].weights);
    options.locked = std::move((*influences)[m].locked);
    options.metric = placings[m];
    options.record_log = true;
    const double share = static_cast<double>(mesh.triangles.size() * uses[m]) / static_cast<double>(all);
    Result<simplify::EdgeCollapseResult> run = simplify::collapse_edges(mesh, options, task.part(share));
    if (!run) return fail(run.error());
    plan.logs_[m] = std::move(*run->log);
    drawn += std::size_t{plan.logs_[m].start_triangles} * uses[m];
    add(plan.locked_, run->locked);
  }
  plan.mesh_of_step_ = merge_order(plan.logs_);
  plan.drawn_after_.reserve(plan.size() + 1);
  plan.drawn_after_.push_back(drawn);
  std::vector<std::size_t> next(original.meshes.size(), 0);
  for (const std::uint32_t m : plan.mesh_of_step_) {
    drawn -= std::size_t{plan.logs_[m].collapses[next[m]++].faces} * uses[m];
    plan.drawn_after_.push_back(drawn);
  }
  return plan;
}

std::size_t CollapsePlan::prefix_for(std::size_t triangles) const {
  const auto found = std::partition_point(drawn_after_.begin(), drawn_after_.end(),
                                          [&](std::size_t left) { return left > triangles; });
  return std::min(size(), static_cast<std::size_t>(found - drawn_after_.begin()));
}

Result<Model> CollapsePlan::model_after(std::size_t count, Task task) const {
  std::vector<std::size_t> counts(logs_.size(), 0);
  for (std::size_t i = 0; i < count; ++i) ++counts[mesh_of_step_[i]];
  Model model;
  model.instances = original_->instances;
  model.materials = original_->materials;
  model.document = original_->document;
  model.meters_per_unit = original_->meters_per_unit;
  model.uv_origin_top = original_->uv_origin_top;
  const double share = 1.0 / static_cast<double>(std::max<std::size_t>(1, logs_.size()));
  for (std::size_t m = 0; m < logs_.size(); ++m) {
    if (logs_[m].start_triangles == 0) {  // not drawn: as it was
      model.meshes.push_back(original_->meshes[m]);
      continue;
    }
    Result<ReplayResult> replayed = replay(mesh(m), logs_[m], counts[m], task.part(share));
    if (!replayed) return fail(replayed.error());
    model.meshes.push_back(std::move(replayed->mesh));
  }
  return model;
}

std::string CollapsePlan::why_it_ends() const {
  std::vector<std::string> causes;
  const auto tell = [&](std::size_t count, const char* text) {
    if (count > 0) causes.push_back(fmt::format("{} {}", with_separators(count), text));
  };
  tell(locked_.seam_corner,
       "where seams, borders or materials meet or end (--weld, or unwrap the model anew, to free them)");
  tell(locked_.non_manifold, "non-manifold (--weld may close cracks; else split the model into clean pieces)");
  tell(locked_.border, "on open borders (leave --keep-border off to free them)");
  tell(locked_.by_request, "locked on request");
  if (causes.empty()) return "no collapse is left that keeps the surface's topology and folds nothing";
  return fmt::format("vertices that cannot move: {}", fmt::join(causes, ", "));
}

}  // namespace lodestone::chain::detail
