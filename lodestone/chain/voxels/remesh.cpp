#include "lodestone/chain/voxels/remesh.h"

#include <optional>

#include "lodestone/base/stopwatch.h"
#include "lodestone/chain/ladder/build_ladder.h"
#include "lodestone/chain/ladder/level_error_detail.h"
#include "lodestone/chain/voxels/voxel_search_detail.h"
#include "lodestone/core/validate.h"

namespace lodestone::chain {

using detail::VoxelCut;
using detail::VoxelTarget;

namespace {

Result<void> check(const RemeshOptions& options) {
  const auto bad = [](std::string what, std::string remedy) {
    return fail(ErrorCode::bad_argument, std::move(what), {}, std::move(remedy));
  };
  const bool count = options.triangles > 0, error = options.error > 0;
  if (count && error) return bad("a triangle count and an error are asked for at once", "choose one");
  if (options.then_collapse && !count && !error) {
    return bad("`then_collapse` needs a target", "add `triangles` or `error`");
  }
  if (options.resolution > 0 && (count || error) && !options.then_collapse) {
    return bad("`resolution` and a target are asked for at once", "choose one, or add `then_collapse`");
  }
  return {};
}

void add_figures(const VoxelLevels& levels, const VoxelCut& cut, RemeshResult& out) {
  const double measuring = out.seconds.measure;
  out.seconds = levels.seconds();
  out.seconds.measure = measuring;
  out.resolution = levels.solid().volume.grid.size;
  out.level_resolution = cut.resolution;
  out.voxels_inside = levels.voxels_inside();
  out.fill = levels.fill();
  const std::vector<std::string>& assumed = levels.solid().warnings;
  out.warnings.insert(out.warnings.end(), assumed.begin(), assumed.end());
}

Result<void> collapse(const Model& model, const RemeshOptions& options, Mesh mesh, RemeshResult& out,
                      const Task& task) {
  LadderOptions ladder;
  ladder.distance = options.distance;
  ladder.constraints.prune = options.prune;
  if (options.triangles > 0) ladder.triangles = {std::min(options.triangles, mesh.triangles.size())};
  if (options.error > 0) ladder.errors = {options.error};
  ladder.start = make_model(std::move(mesh), model);
  Result<LadderResult> made = build_ladder(model, ladder, task);
  LODESTONE_TRY(made);
  if (!made->shortfalls.empty()) out.shortfall = made->shortfalls.front().reason;
  if (made->ladder.levels.size() < 2) {
    return fail(ErrorCode::bad_argument, "the surface by voxels is not within the error that is asked for", {},
                "raise `resolution`");
  }
  out.level = std::move(made->ladder.levels[1]);
  out.level.method = "voxels and edge collapse";
  out.seconds.collapse += made->simplify_seconds;
  out.seconds.measure += made->measure_seconds;
  return {};
}

Result<void> finish_level(const Model& model, const RemeshOptions& options, VoxelCut cut,
                          const measure::Reference* reference, RemeshResult& out, const Task& task) {
  Level& level = out.level;
  level.triangles = cut.mesh.triangles.size();
  level.method = "voxels";
  level.model = make_model(std::move(cut.mesh), model);
  if (reference != nullptr && !cut.distance) {
    const Stopwatch measuring;
    const Result<measure::Distance> d = reference->distance_to(level.model, detail::of_valid(options.distance), task);
    LODESTONE_TRY(d);
    cut.distance = *d;
    out.seconds.measure += measuring.total();
  }
  out.measured = cut.distance.has_value();
  if (cut.distance) level.error = detail::level_error(*cut.distance);
  return {};
}

}  // namespace

Result<RemeshResult> remesh(const Model& model, const RemeshOptions& options, Task task) {
  LODESTONE_TRY(check(options));
  LODESTONE_TRY(validate(model, task));
  const VoxelTarget target{options.resolution, options.triangles, options.error, options.then_collapse};
  RemeshResult out;
  const Stopwatch watch;
  const Result<std::uint32_t> finest = detail::finest_for(model, options.voxel, target, task.part(0.1));
  LODESTONE_TRY(finest);
  Result<VoxelLevels> levels = VoxelLevels::create(model, options.voxel, *finest, task.part(0.3));
  LODESTONE_TRY(levels);
  // Collapsing measures by itself; surfaces made slab by slab are too large for it.
  const bool measures = options.measure && !levels->by_slabs() && !options.then_collapse;
  if (options.measure && levels->by_slabs()) {
    out.warnings.emplace_back("the error is not measured on a surface as large as this: 'lod measure' does it");
  }
  std::optional<measure::Reference> reference;
  if (measures || detail::needs_reference(target)) {
    const Stopwatch preparing;
    Result<measure::Reference> made = measure::Reference::create(model, task.part(0.1));
    LODESTONE_TRY(made);
    reference.emplace(std::move(*made));
    out.seconds.measure += preparing.total();
  }
  const measure::Reference* known = reference ? &*reference : nullptr;
  Result<VoxelCut> cut = detail::cut_for(*levels, target, *finest, known, options.distance, task.part(0.2));
  LODESTONE_TRY(cut);
  add_figures(*levels, *cut, out);
  if (!levels->by_slabs()) detail::tell_vanished(*levels, model, *cut, out.warnings);
  if (!options.then_collapse) out.shortfall = detail::shortfall_of(target, *cut);
  const Task rest = task.part(0.3, options.then_collapse ? "collapsing" : "measuring");
  LODESTONE_TRY(options.then_collapse ? collapse(model, options, std::move(cut->mesh), out, rest)
                                      : finish_level(model, options, std::move(*cut), known, out, rest));
  out.level.seconds = watch.total();
  return out;
}

}  // namespace lodestone::chain
