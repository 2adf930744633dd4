#include "lodestone/chain/voxels/boolean.h"

#include <fmt/format.h>

#include "lodestone/base/stopwatch.h"
#include "lodestone/core/validate.h"

namespace lodestone::chain {

namespace {

// All models in one scene: what the result's surface is made of.
Model joined(std::span<const Model> models) {
  Model out;
  for (const Model& model : models) {
    const auto first = static_cast<std::uint32_t>(out.meshes.size());
    out.meshes.insert(out.meshes.end(), model.meshes.begin(), model.meshes.end());
    for (Instance instance : model.instances) {
      instance.mesh += first;
      out.instances.push_back(std::move(instance));
    }
  }
  return out;
}

Result<void> check(std::span<const Model> models, const BooleanOptions& options) {
  if (models.empty() || options.operations.size() + 1 != models.size()) {
    return fail(ErrorCode::bad_argument, "models and operations do not fit together");
  }
  for (const Model& model : models) {
    const double a = models.front().meters_per_unit, b = model.meters_per_unit;
    if (a > 0 && b > 0 && !(a > b * 0.999 && a < b * 1.001)) {
      return fail(ErrorCode::bad_argument, "the models are in different units", {}, "convert one of them first");
    }
  }
  return {};
}

}  // namespace

Result<BooleanResult> boolean(std::span<const Model> models, const BooleanOptions& options, Task task) {
  LODESTONE_TRY(check(models, options));
  for (std::size_t i = 0; i < models.size(); ++i) {
    const Result<void> ok = validate(models[i], task);
    if (!ok) return fail(ok.error().code, ok.error().what, fmt::format("model {}, {}", i + 1, ok.error().where));
  }
  BooleanResult out;
  Stopwatch watch;
  Model scene = joined(models);
  const std::uint32_t supersample = options.voxel.supersample > 0 ? options.voxel.supersample : 4;
  SolidOptions solid_options;
  solid_options.resolution = options.resolution * supersample;
  solid_options.margin = solid_options.multiple = supersample;
  const Result<VoxelGrid> grid = solid_grid(bounds_of(scene), {}, solid_options);
  LODESTONE_TRY(grid);
  std::optional<Solid> solid;
  for (std::size_t i = 0; i < models.size(); ++i) {
    const Task part = task.part(0.6 / static_cast<double>(models.size()));
    Result<FillChoice> choice = choose_fill(models[i], options.voxel.fill, part);
    LODESTONE_TRY(choice);
    choice->close = options.voxel.close;
    Result<Solid> made = solid_in(models[i], *choice, *grid, part);
    if (!made) {
      Error error = made.error();
      if (error.where.empty()) error.where = fmt::format("model {}", i + 1);
      return fail(std::move(error));
    }
    out.seconds.voxelize += made->seconds.slicing + made->seconds.filling;
    out.warnings.insert(out.warnings.end(), made->warnings.begin(), made->warnings.end());
    if (i == 0) {
      out.fill = *choice;
      solid = std::move(*made);
      continue;
    }
    LODESTONE_TRY(voxel::combine(solid->volume, made->volume, options.operations[i - 1]));
  }
  if (solid->volume.set_count() == 0) return fail(ErrorCode::empty, "nothing is left: the result has no volume");
  Result<spatial::Surface> surface = spatial::flatten(scene, Input::valid, task);
  LODESTONE_TRY(surface);
  solid->surface = std::move(*surface);
  out.seconds.prepare = watch.total() - out.seconds.voxelize;
  Result<VoxelLevels> levels = VoxelLevels::of_solid(std::move(*solid), out.fill, options.voxel, task);
  LODESTONE_TRY(levels);
  Result<Mesh> mesh = levels->surface_at(options.resolution, task.part(0.3, "contouring"));
  LODESTONE_TRY(mesh);
  out.resolution = levels->solid().volume.grid.size;
  out.voxels_inside = levels->voxels_inside();
  out.seconds.resample = levels->seconds().resample;
  out.seconds.isosurface = levels->seconds().isosurface;
  out.model = make_model(std::move(*mesh), models.front());
  return out;
}

}  // namespace lodestone::chain
