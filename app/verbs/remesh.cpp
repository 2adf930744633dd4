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
  if (!target) return fail(target.error());
  options.then_collapse = arguments.has("--then-collapse");
  options.prune = arguments.has("--prune");
  if (options.prune && !options.then_collapse) {
    return fail(ErrorCode::bad_argument, "--prune is for --then-collapse", {}, "add --then-collapse");
  }
  if (arguments.has("--resolution") || target->empty()) {
    const Result<std::uint32_t> resolution = resolution_of(arguments);
    if (!resolution) return fail(resolution.error());
    options.resolution = *resolution;
  }
  if (*target == "--triangles") {
    const Result<std::uint64_t> count = arguments.count("--triangles", 4, std::uint64_t{1} << 32);
    if (!count) return fail(count.error());
    options.triangles = *count;
  }
  if (*target == "--error") {
    const Result<std::vector<LengthArgument>> error = length_list(arguments, "--error", lengths);
    if (!error) return fail(error.error());
    if (error->size() != 1) return fail(ErrorCode::bad_argument, "--error takes one value here");
    const Result<std::vector<double>> units = to_model_units(*error, model, bounds_of(model).diagonal());
    if (!units) return fail(units.error());
    options.error = units->front();
    doubt_lengths("--error", *error, model, warnings);
  }
  const Result<chain::VoxelOptions> voxel = voxel_options(arguments, lengths, model);
  if (!voxel) return fail(voxel.error());
  options.voxel = *voxel;
  const Result<measure::DistanceOptions> distance = distance_options(arguments);
  if (!distance) return fail(distance.error());
  options.distance = *distance;
  return options;
}

}  // namespace

Result<ExitCode> run_remesh(const Arguments& arguments, Console& console) {
  Result<VoxelRequest> request = voxel_request(arguments, "remesh");
  if (!request) return fail(request.error());
  const Result<LengthRules> lengths = length_rules(arguments);
  if (!lengths) return fail(lengths.error());
  const Result<chain::SurfaceAttributeOptions> attributes = surface_attributes(arguments);
  if (!attributes) return fail(attributes.error());
  Stopwatch watch;
  VoxelReport report;
  Result<Model> model = read_solid(*request, report, console);
  if (!model) return fail(model.error());
  apply_unit(*model, *lengths);
  report.unit = unit_name(model->meters_per_unit);
  report.read_seconds = watch.lap();
  std::vector<std::string> warnings;
  const Result<chain::RemeshOptions> options = remesh_options(arguments, *lengths, *model, warnings);
  if (!options) return fail(options.error());
  tell(report, warnings, console);
  Result<chain::RemeshResult> result = chain::remesh(*model, *options, console.task().part(0.8, "remeshing"));
  if (!result) return fail(with_place(result.error(), report.input));
  add_solid(report, result->fill, result->resolution, result->voxels_inside);
  add_seconds(report, result->seconds);
  report.level_resolution = result->level_resolution;
  report.method = result->level.method;
  report.shortfall = result->shortfall;
  if (result->measured) report.error = result->level.error;
  const Result<void> decoded = decode_for(*attributes, *model, result->warnings, console.task());
  if (!decoded) return fail(decoded.error());
  const Result<chain::AttributeSource> source = chain::AttributeSource::create(*model, *attributes, console.task());
  if (!source) return fail(source.error());
  if (const Result<void> added = source->add_to(result->level.model, 0, console.task()); !added) {
    return fail(with_place(added.error(), report.input));
  }
  tell(report, result->warnings, console);
  const Result<void> done = finish(result->level.model, *request, watch, report, console);
  if (!done) return fail(done.error());
  if (report.shortfall.empty()) return ExitCode::done;
  console.shortfall(fmt::format("{}: {}", report.input, report.shortfall));
  return ExitCode::fell_short;
}

}  // namespace lodestone::app
