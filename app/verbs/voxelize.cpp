#include "app/options/voxel_options.h"
#include "app/verbs/verbs.h"
#include "app/verbs/voxel_run.h"
#include "lodestone/voxel/cube_faces.h"

namespace lodestone::app {

Result<ExitCode> run_voxelize(const Arguments& arguments, Console& console) {
  const Result<VoxelRequest> request = voxel_request(arguments, "voxelize");
  LODESTONE_TRY(request);
  const Result<std::uint32_t> resolution = resolution_of(arguments);
  LODESTONE_TRY(resolution);
  const Result<LengthRules> lengths = length_rules(arguments);
  LODESTONE_TRY(lengths);
  Stopwatch watch;
  VoxelReport report;
  Result<Model> model = read_solid(*request, report, console);
  LODESTONE_TRY(model);
  apply_unit(*model, *lengths);
  report.unit = unit_name(model->meters_per_unit);
  report.read_seconds = watch.lap();
  const Result<chain::VoxelOptions> voxel = voxel_options(arguments, *lengths, *model);
  LODESTONE_TRY(voxel);
  Result<chain::FillChoice> choice = chain::choose_fill(*model, voxel->fill, console.task());
  if (!choice) return fail(with_place(choice.error(), report.input));
  choice->close = voxel->close;
  chain::SolidOptions options;
  options.resolution = *resolution;
  const Result<chain::Solid> solid = chain::solid_of(*model, *choice, options, console.task().part(0.4, "voxelizing"));
  if (!solid) return fail(with_place(solid.error(), report.input));
  add_solid(report, *choice, solid->volume.grid.size, solid->volume.set_count());
  tell(report, solid->warnings, console);
  report.voxelize_seconds = solid->seconds.slicing + solid->seconds.filling;
  report.prepare_seconds = watch.lap() - report.voxelize_seconds;
  Result<Mesh> mesh = voxel::cube_faces(solid->volume, console.task().part(0.4, "making cubes"));
  LODESTONE_TRY(mesh);
  const Model cubes = make_model(std::move(*mesh), *model);
  report.isosurface_seconds = watch.lap();
  LODESTONE_TRY(finish(cubes, *request, watch, report, console));
  return ExitCode::done;
}

}  // namespace lodestone::app
