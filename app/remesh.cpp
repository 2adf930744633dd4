#include "lodestone/chain/remesh.h"
#include "app/json.h"
#include "app/shared_options.h"
#include "app/verbs.h"
#include "app/voxel_options.h"
#include "app/voxel_run.h"
#include "lodestone/base/stopwatch.h"

namespace lodestone::app {

Result<ExitCode> run_remesh(const Arguments& arguments, Console& console) {
  const Result<VoxelRequest> request = voxel_request(arguments, "remesh");
  if (!request) return fail(request.error());
  chain::RemeshOptions options;
  options.resolutions = {request->resolution};
  options.fill = request->fill;
  options.project = !arguments.has("--no-project");
  if (arguments.has("--supersample")) {
    const Result<std::uint64_t> supersample = arguments.count("--supersample", 1, 64);
    if (!supersample) return fail(supersample.error());
    options.supersample = static_cast<std::uint32_t>(*supersample);
  }
  const Result<measure::DistanceOptions> distance = distance_options(arguments);
  if (!distance) return fail(distance.error());
  options.distance = *distance;

  Stopwatch watch;
  VoxelReport report;
  const Result<Model> model = read_solid(*request, report, console);
  if (!model) return fail(model.error());
  report.read_seconds = watch.lap();
  const Result<chain::RemeshResult> result = chain::remesh(*model, options, console.task().part(0.8, "remeshing"));
  if (!result) return fail(result.error());
  const Level& level = result->levels.front();
  report.resolution = result->resolution;
  report.voxels_inside = result->voxels_inside;
  report.fill = name_of(result->fill.fill);
  report.fill_reason = result->fill.reason;
  report.triangles = level.triangles;
  report.error = level.error;
  report.prepare_seconds = result->seconds.prepare;
  report.voxelize_seconds = result->seconds.voxelize;
  report.resample_seconds = result->seconds.resample;
  report.isosurface_seconds = result->seconds.isosurface;
  report.measure_seconds = result->seconds.measure;
  tell(report, result->warnings, console);
  watch.lap();
  if (const Result<void> written = write_surface(level.model, *request, report, console); !written) {
    return fail(written.error());
  }
  report.write_seconds = watch.lap();
  report.total_seconds = watch.total();
  console.result(arguments.has("--json") ? to_json(report) : table_of(report));
  return ExitCode::done;
}

}  // namespace lodestone::app
