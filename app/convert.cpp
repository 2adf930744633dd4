#include <fmt/format.h>

#include "app/input.h"
#include "app/json.h"
#include "app/shared_options.h"
#include "app/text.h"
#include "app/verbs.h"
#include "lodestone/base/stopwatch.h"
#include "lodestone/base/units.h"

namespace lodestone::app {
namespace {

Result<std::string> output_of(const Arguments& arguments) {
  const bool as_option = arguments.has("--output");
  if (arguments.inputs.size() == 2 && as_option) {
    return fail(ErrorCode::bad_argument, "the output is named twice", {}, "give it as the second name or with -o");
  }
  if (arguments.inputs.size() == 2) return arguments.inputs[1];
  if (as_option) return arguments.text("--output");
  return missing_output("convert", arguments.inputs[0]);
}

}  // namespace

Result<ExitCode> run_convert(const Arguments& arguments, Console& console) {
  ConvertReport report;
  report.input = arguments.inputs[0];
  const Result<std::string> output = output_of(arguments);
  if (!output) return fail(output.error());
  const io::Compression compression = compression_of(arguments);
  if (const Result<void> checked = check_output(*output, {report.input}, compression); !checked) {
    return fail(checked.error());
  }

  const Result<VolumeRequest> volume = volume_request(arguments);
  if (!volume) return fail(volume.error());
  Stopwatch watch;
  const Result<Model> model = read_input(report.input, console, console.task().part(0.5, "reading"), {}, *volume);
  if (!model) return fail(model.error());
  report.read_seconds = watch.lap();
  report.triangles = drawn_triangles(*model);
  report.warnings = model->warnings;
  const Result<io::WriteReport> written =
      io::write_model(*model, *output, io::WriteOptions{compression, {}}, console.task().part(0.5, "writing"));
  if (!written) return fail(written.error());
  console.wrote(*output);
  report.write_seconds = watch.lap();
  report.bytes = written->total_bytes;
  for (const auto& file : written->files) report.files.push_back(file.string());
  for (const std::string& warning : written->warnings) {
    console.note(fmt::format("{}: {}", *output, warning));
    report.warnings.push_back(warning);
  }
  console.result(arguments.has("--json") ? to_json(report)
                                         : fmt::format("{}: {} triangles, {}\n", printable(*output),
                                                       with_separators(report.triangles), human_bytes(report.bytes)));
  return ExitCode::done;
}

}  // namespace lodestone::app
