#include "app/verbs/voxel_run.h"

#include <fmt/format.h>

#include "app/input.h"
#include "app/options/shared_options.h"
#include "app/options/voxel_options.h"
#include "app/output/json.h"
#include "app/output/table.h"
#include "app/output/text.h"
#include "lodestone/base/units.h"

namespace lodestone::app {

namespace {

std::string table_of(const VoxelReport& report) {
  Table table;
  table.add_column("", Table::Align::left);
  table.add_column("", Table::Align::left);
  table.add_row({"voxels", fmt::format("{} inside of {} x {} x {}", with_separators(report.voxels_inside),
                                       report.resolution[0], report.resolution[1], report.resolution[2])});
  table.add_row({"filled by", fmt::format("{} ({})", report.fill, report.fill_reason)});
  table.add_row({"triangles", fmt::format("{}, {} in the input", with_separators(report.triangles),
                                          with_separators(report.triangles_in))});
  if (report.level_resolution > 0) {
    table.add_row(
        {"method", fmt::format("{}, {} voxels along the longest side", report.method, report.level_resolution)});
  }
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
      {"seconds",
       fmt::format("read {}, prepare {}, voxelize {}, resample {}, surface {}, collapse {}, measure {}, write {}",
                   seconds_text(report.read_seconds), seconds_text(report.prepare_seconds),
                   seconds_text(report.voxelize_seconds), seconds_text(report.resample_seconds),
                   seconds_text(report.isosurface_seconds), seconds_text(report.collapse_seconds),
                   seconds_text(report.measure_seconds), seconds_text(report.write_seconds))});
  return table.text();
}

}  // namespace

Result<VoxelRequest> voxel_request(const Arguments& arguments, const char* verb) {
  VoxelRequest request;
  request.input = arguments.inputs.front();
  if (!arguments.has("--output")) return missing_output(verb, request.input);
  request.output = arguments.text("--output");
  Result<VolumeRequest> volume = volume_request(arguments);
  LODESTONE_TRY(volume);
  request.volume = std::move(*volume);
  request.compression = compression_of(arguments);
  request.json = arguments.has("--json");
  LODESTONE_TRY(check_output(request.output, {request.input}, request.compression));
  return request;
}

Result<Model> read_solid(const VoxelRequest& request, VoxelReport& report, const Console& console) {
  Result<Model> model = read_input(request.input, console, console.task().part(0.1, "reading"), {}, request.volume);
  if (!model) return model;
  LODESTONE_TRY(io::check_replaced(*model, request.output));
  report.input = request.input;
  report.output = request.output;
  report.triangles_in = drawn_triangles(*model);
  report.unit = unit_name(model->meters_per_unit);
  report.warnings = model->warnings;
  return model;
}

void add_solid(VoxelReport& report, const chain::FillChoice& fill, const std::array<std::uint32_t, 3>& resolution,
               std::uint64_t voxels_inside) {
  report.resolution = resolution;
  report.voxels_inside = voxels_inside;
  report.fill = name_of(fill.fill);
  report.fill_reason = fill.reason;
}

void add_seconds(VoxelReport& report, const chain::VoxelSeconds& seconds) {
  report.prepare_seconds = seconds.prepare;
  report.voxelize_seconds = seconds.voxelize;
  report.resample_seconds = seconds.resample;
  report.isosurface_seconds = seconds.isosurface;
  report.collapse_seconds = seconds.collapse;
  report.measure_seconds = seconds.measure;
}

Result<void> finish(const Model& model, const VoxelRequest& request, Stopwatch& watch, VoxelReport& report,
                    Console& console) {
  watch.lap();
  report.triangles = drawn_triangles(model);
  const Result<io::WriteReport> written =
      io::write_model(model, request.output, {request.compression, {}}, console.task().part(0.1, "writing"));
  LODESTONE_TRY(written);
  console.wrote(request.output);
  report.bytes = written->total_bytes;
  for (const std::string& warning : written->warnings) {
    console.note(fmt::format("{}: {}", request.output, warning));
    report.warnings.push_back(warning);
  }
  report.peak_memory_bytes = peak_memory_bytes();
  report.write_seconds = watch.lap();
  report.total_seconds = watch.total();
  request.json ? console.result(to_json(report)) : console.table(table_of(report));
  return {};
}

void tell(VoxelReport& report, const std::vector<std::string>& warnings, const Console& console) {
  for (const std::string& warning : warnings) {
    console.note(fmt::format("{}: {}", report.input, warning));
    report.warnings.push_back(warning);
  }
}

Error with_place(Error error, const std::string& place) {
  if (error.where.empty()) error.where = place;
  return error;
}

}  // namespace lodestone::app
