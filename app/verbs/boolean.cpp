#include <fmt/format.h>

#include "app/input.h"
#include "app/options/shared_options.h"
#include "app/options/voxel_options.h"
#include "app/verbs/verbs.h"
#include "app/verbs/voxel_run.h"
#include "lodestone/chain/voxels/boolean.h"

namespace lodestone::app {

namespace {

struct BooleanRequest {
  std::vector<std::string> inputs;
  std::vector<voxel::BooleanOperation> operations;
  std::string output;
};

std::optional<voxel::BooleanOperation> operation_of(const std::string& word) {
  if (word == "union") return voxel::BooleanOperation::unite;
  if (word == "intersection") return voxel::BooleanOperation::intersect;
  if (word == "difference") return voxel::BooleanOperation::subtract;
  return std::nullopt;
}

// Models and operations in turn; what is left over is the output.
Result<BooleanRequest> boolean_request(const Arguments& arguments) {
  const auto bad = [](std::string what) {
    return fail(ErrorCode::bad_argument, std::move(what), {}, "such as: lod boolean a.ply union b.ply out.ply");
  };
  BooleanRequest request;
  std::vector<std::string> words = arguments.inputs;
  if (arguments.has("--output")) {
    request.output = arguments.text("--output");
  } else {
    request.output = words.back();
    words.pop_back();
    if (words.size() % 2 == 0) return bad("boolean needs an output");
  }
  if (words.size() < 3 || words.size() % 2 == 0) return bad("models and operations must stand in turn");
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i % 2 == 0) {
      request.inputs.push_back(words[i]);
      continue;
    }
    const auto operation = operation_of(words[i]);
    if (!operation) return bad(fmt::format("'{}' is no operation: union, intersection or difference", words[i]));
    request.operations.push_back(*operation);
  }
  return request;
}

}  // namespace

Result<ExitCode> run_boolean(const Arguments& arguments, Console& console) {
  const Result<BooleanRequest> asked = boolean_request(arguments);
  LODESTONE_TRY(asked);
  VoxelRequest request;
  request.output = asked->output;
  request.compression = compression_of(arguments);
  request.json = arguments.has("--json");
  const std::vector<std::filesystem::path> paths(asked->inputs.begin(), asked->inputs.end());
  LODESTONE_TRY(check_output(request.output, paths, request.compression));
  const Result<std::uint32_t> resolution = resolution_of(arguments);
  LODESTONE_TRY(resolution);
  const Result<LengthRules> lengths = length_rules(arguments);
  LODESTONE_TRY(lengths);
  const Result<measure::DistanceOptions> distance = distance_options(arguments);
  LODESTONE_TRY(distance);

  Stopwatch watch;
  VoxelReport report;
  std::vector<Model> models;
  VolumeRequest reading;
  reading.up = up_axis(arguments);
  for (const std::string& input : asked->inputs) {
    Result<Model> model = read_input(input, console, console.task().part(0.2, "reading"), {}, reading);
    LODESTONE_TRY(model);
    LODESTONE_TRY(io::check_replaced(*model, request.output));
    apply_unit(*model, *lengths);
    report.input += (report.input.empty() ? "" : ", ") + input;
    report.triangles_in += drawn_triangles(*model);
    models.push_back(std::move(*model));
  }
  report.output = request.output;
  report.unit = unit_name(models.front().meters_per_unit);
  report.read_seconds = watch.lap();
  chain::BooleanOptions options;
  options.resolution = *resolution;
  options.operations = asked->operations;
  const Result<chain::VoxelOptions> voxel = voxel_options(arguments, *lengths, models.front());
  LODESTONE_TRY(voxel);
  options.voxel = *voxel;
  const Result<chain::BooleanResult> result = chain::boolean(models, options, console.task().part(0.7, "combining"));
  LODESTONE_TRY(result);
  add_solid(report, result->fill, result->resolution, result->voxels_inside);
  add_seconds(report, result->seconds);
  report.level_resolution = *resolution;
  report.method = "voxels";
  tell(report, result->warnings, console);
  LODESTONE_TRY(finish(result->model, request, watch, report, console));
  return ExitCode::done;
}

}  // namespace lodestone::app
