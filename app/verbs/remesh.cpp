#include "lodestone/chain/voxels/remesh.h"

#include <fmt/format.h>

#include "app/options/shared_options.h"
#include "app/options/surface_attributes.h"
#include "app/options/voxel_options.h"
#include "app/verbs/verbs.h"
#include "app/verbs/voxel_run.h"

namespace lodestone::app {

namespace {

// The target, for a model whose size is known.
Result<chain::RemeshOptions> remesh_options(const Arguments& arguments, const LengthRules& lengths, const Model& model,
                                            std::vector<std::string>& warnings) {
  chain::RemeshOptions options;
  const Result<std::string> target = given_target(arguments, {"--triangles", "--error"}, "choose one");
  LODESTONE_TRY(target);
  options.then_collapse = arguments.has("--then-collapse");
  options.prune = arguments.has("--prune");
  if (options.prune && !options.then_collapse) {
    return fail(ErrorCode::bad_argument, "--prune is for --then-collapse", {}, "add --then-collapse");
  }
  if (arguments.has("--resolution") || target->empty()) {
    const Result<std::uint32_t> resolution = resolution_of(arguments);
    LODESTONE_TRY(resolution);
    options.resolution = *resolution;
  }
  if (*target == "--triangles") {
    const Result<std::uint64_t> count = arguments.count("--triangles", 4, std::uint64_t{1} << 32);
    LODESTONE_TRY(count);
    options.triangles = *count;
  }
  if (*target == "--error") {
    const Result<std::vector<LengthArgument>> error = length_list(arguments, "--error", lengths);
    LODESTONE_TRY(error);
    if (error->size() != 1) return fail(ErrorCode::bad_argument, "--error takes one value here");
    const Result<std::vector<double>> units = to_model_units(*error, model, bounds_of(model).diagonal());
    LODESTONE_TRY(units);
    options.error = units->front();
    doubt_lengths("--error", *error, model, warnings);
  }
  const Result<chain::VoxelOptions> voxel = voxel_options(arguments, lengths, model);
  LODESTONE_TRY(voxel);
  options.voxel = *voxel;
  const Result<measure::DistanceOptions> distance = distance_options(arguments);
  LODESTONE_TRY(distance);
  options.distance = *distance;
  return options;
}

}  // namespace

Result<ExitCode> run_remesh(const Arguments& arguments, Console& console) {
  Result<VoxelRequest> request = voxel_request(arguments, "remesh");
  LODESTONE_TRY(request);
  const Result<LengthRules> lengths = length_rules(arguments);
  LODESTONE_TRY(lengths);
  const Result<chain::SurfaceAttributeOptions> attributes = surface_attributes(arguments);
  LODESTONE_TRY(attributes);
  Stopwatch watch;
  VoxelReport report;
  Result<Model> model = read_solid(*request, report, console);
  LODESTONE_TRY(model);
  apply_unit(*model, *lengths);
  report.unit = unit_name(model->meters_per_unit);
  report.read_seconds = watch.lap();
  std::vector<std::string> warnings;
  const Result<chain::RemeshOptions> options = remesh_options(arguments, *lengths, *model, warnings);
  LODESTONE_TRY(options);
  tell(report, warnings, console);
  Result<chain::RemeshResult> result = chain::remesh(*model, *options, console.task().part(0.8, "remeshing"));
  if (!result) return fail(with_place(result.error(), report.input));
  add_solid(report, result->fill, result->resolution, result->voxels_inside);
  add_seconds(report, result->seconds);
  report.level_resolution = result->level_resolution;
  report.method = result->level.method;
  report.shortfall = result->shortfall;
  if (result->measured) report.error = result->level.error;
  LODESTONE_TRY(decode_for(*attributes, *model, result->warnings, console.task()));
  const Result<chain::AttributeSource> source = chain::AttributeSource::create(*model, *attributes, console.task());
  LODESTONE_TRY(source);
  if (const Result<void> added = source->add_to(result->level.model, 0, console.task()); !added) {
    return fail(with_place(added.error(), report.input));
  }
  tell(report, result->warnings, console);
  const Result<void> done = finish(result->level.model, *request, watch, report, console);
  LODESTONE_TRY(done);
  if (report.shortfall.empty()) return ExitCode::done;
  console.shortfall(fmt::format("{}: {}", report.input, report.shortfall));
  return ExitCode::fell_short;
}

}  // namespace lodestone::app
