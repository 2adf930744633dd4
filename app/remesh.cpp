#include "lodestone/chain/remesh.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/input.h"
#include "app/json.h"
#include "app/shared_options.h"
#include "app/table.h"
#include "app/text.h"
#include "app/verbs.h"
#include "app/voxel_options.h"
#include "lodestone/base/stopwatch.h"
#include "lodestone/base/units.h"
#include "lodestone/chain/solid.h"
#include "lodestone/voxel/cube_faces.h"

namespace lodestone::app {
namespace {

struct Request {
  std::string input, output;
  std::uint32_t resolution = 0;
  std::optional<voxel::FillRule> fill;
  io::Compression compression = io::Compression::none;
};

Result<Request> request_of(const Arguments& arguments, const char* verb) {
  Request request;
  request.input = arguments.inputs.front();
  if (!arguments.has("--output")) return missing_output(verb, request.input);
  request.output = arguments.text("--output");
  const Result<std::uint32_t> resolution = resolution_of(arguments);
  if (!resolution) return fail(resolution.error());
  request.resolution = *resolution;
  request.fill = fill_of(arguments);
  request.compression = compression_of(arguments);
  const Result<void> checked = check_output(request.output, {request.input}, request.compression);
  if (!checked) return fail(checked.error());
  return request;
}

Result<Model> read(const Request& request, VoxelReport& report, const Console& console) {
  Result<Model> model = read_input(request.input, console, console.task().part(0.1, "reading"));
  if (!model) return model;
  if (const Result<void> kept = io::check_replaced(*model, request.output); !kept) return fail(kept.error());
  report.input = request.input;
  report.output = request.output;
  report.triangles_in = drawn_triangles(*model);
  report.unit = unit_name(model->meters_per_unit);
  report.warnings = model->warnings;
  return model;
}

Result<void> write(const Model& model, const Request& request, VoxelReport& report, Console& console) {
  const Result<io::WriteReport> written =
      io::write_model(model, request.output, {request.compression, {}}, console.task().part(0.1, "writing"));
  if (!written) return fail(written.error());
  console.wrote(request.output);
  report.bytes = written->total_bytes;
  for (const std::string& warning : written->warnings) {
    console.note(fmt::format("{}: {}", request.output, warning));
    report.warnings.push_back(warning);
  }
  report.peak_memory_bytes = peak_memory_bytes();
  return {};
}

std::string table_of(const VoxelReport& report) {
  Table table;
  table.add_column("", Table::Align::left);
  table.add_column("", Table::Align::left);
  table.add_row({"voxels", fmt::format("{} inside of {} x {} x {}", with_separators(report.voxels_inside),
                                       report.resolution[0], report.resolution[1], report.resolution[2])});
  table.add_row({"filled by", fmt::format("{} ({})", report.fill, report.fill_reason)});
  table.add_row({"triangles", fmt::format("{}, {} in the input", with_separators(report.triangles),
                                          with_separators(report.triangles_in))});
  if (report.error) {
    const LevelError& e = *report.error;
    const std::string unit = report.unit.empty() ? "" : " " + report.unit;
    table.add_row({"error", fmt::format("{}{} ({} of the diagonal, {})", short_number(e.error), unit,
                                        percent(e.relative(e.error)), to_string(e.kind))});
    table.add_row(
        {"mean error", fmt::format("{}{} ({})", short_number(e.mean_error), unit, percent(e.relative(e.mean_error)))});
  }
  table.add_row({"file", fmt::format("{} ({})", printable(report.output), human_bytes(report.bytes))});
  table.add_row(
      {"seconds", fmt::format("read {}, prepare {}, voxelize {}, resample {}, surface {}, measure {}, write {}",
                              seconds_text(report.read_seconds), seconds_text(report.prepare_seconds),
                              seconds_text(report.voxelize_seconds), seconds_text(report.resample_seconds),
                              seconds_text(report.isosurface_seconds), seconds_text(report.measure_seconds),
                              seconds_text(report.write_seconds))});
  return table.text();
}

void tell(VoxelReport& report, const std::vector<std::string>& warnings, const Console& console) {
  for (const std::string& warning : warnings) {
    console.note(fmt::format("{}: {}", report.input, warning));
    report.warnings.push_back(warning);
  }
}

}  // namespace

Result<ExitCode> run_remesh(const Arguments& arguments, Console& console) {
  const Result<Request> request = request_of(arguments, "remesh");
  if (!request) return fail(request.error());
  chain::RemeshOptions options;
  options.resolutions = {request->resolution};
  options.fill = request->fill;
  options.project = !arguments.has("--no-project");
  if (arguments.has("--supersample")) {
    const Result<std::uint64_t> ratio = arguments.count("--supersample", 1, 64);
    if (!ratio) return fail(ratio.error());
    options.ratio = static_cast<std::uint32_t>(*ratio);
  }
  const Result<measure::DistanceOptions> distance = distance_options(arguments);
  if (!distance) return fail(distance.error());
  options.distance = *distance;

  Stopwatch watch;
  VoxelReport report;
  const Result<Model> model = read(*request, report, console);
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
  if (const Result<void> written = write(level.model, *request, report, console); !written) {
    return fail(written.error());
  }
  report.write_seconds = watch.lap();
  report.total_seconds = watch.total();
  console.result(arguments.has("--json") ? to_json(report) : table_of(report));
  return ExitCode::done;
}

Result<ExitCode> run_voxelize(const Arguments& arguments, Console& console) {
  const Result<Request> request = request_of(arguments, "voxelize");
  if (!request) return fail(request.error());
  Stopwatch watch;
  VoxelReport report;
  const Result<Model> model = read(*request, report, console);
  if (!model) return fail(model.error());
  report.read_seconds = watch.lap();
  const Result<chain::FillChoice> choice = chain::choose_fill(*model, request->fill, console.task());
  if (!choice) return fail(choice.error());
  chain::SolidOptions options;
  options.resolution = request->resolution;
  const Result<chain::Solid> solid = chain::solid_of(*model, *choice, options, console.task().part(0.4, "voxelizing"));
  if (!solid) return fail(solid.error());
  report.resolution = solid->volume.grid.size;
  report.voxels_inside = solid->volume.set_count();
  report.fill = name_of(choice->fill);
  report.fill_reason = choice->reason;
  tell(report, solid->warnings, console);
  report.voxelize_seconds = solid->seconds.slicing + solid->seconds.filling;
  report.prepare_seconds = watch.lap() - report.voxelize_seconds;
  Result<Mesh> mesh = voxel::cube_faces(solid->volume, console.task().part(0.4, "making cubes"));
  if (!mesh) return fail(mesh.error());
  Model cubes = make_model(std::move(*mesh));
  cubes.meters_per_unit = model->meters_per_unit;
  report.triangles = drawn_triangles(cubes);
  report.isosurface_seconds = watch.lap();
  if (const Result<void> written = write(cubes, *request, report, console); !written) return fail(written.error());
  report.write_seconds = watch.lap();
  report.total_seconds = watch.total();
  console.result(arguments.has("--json") ? to_json(report) : table_of(report));
  return ExitCode::done;
}

}  // namespace lodestone::app
