#include <fmt/format.h>

#include "app/input.h"
#include "app/options/shared_options.h"
#include "app/output/json.h"
#include "app/output/text.h"
#include "app/verbs/verbs.h"
#include "lodestone/base/file.h"
#include "lodestone/base/stopwatch.h"
#include "lodestone/base/units.h"
#include "lodestone/io/gltf/levels.h"

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

struct Plan {
  std::string input, output;
  io::ReadOptions read;
  std::uint64_t levels = 0;  // files to write; 0: the output has no {level}
  LengthRules lengths;
  VolumeRequest volume;
  io::Compression compression = io::Compression::none;
};

// --level and {level}: which levels of the input are wanted.
Result<void> plan_levels(const Arguments& arguments, Plan& plan) {
  const Result<std::uint64_t> level = arguments.count("--level", 0, 1024);
  LODESTONE_TRY(level);
  if (is_level_pattern(plan.output)) {
    if (arguments.has("--level")) {
      return fail(ErrorCode::bad_argument, "--level takes one level, {level} in the output writes all", {},
                  "leave one of them out");
    }
    if (const Result<InputFile> there = InputFile::open(plan.input); !there) return fail(there.error());
    plan.levels = io::levels_in_file(plan.input);
    plan.read.levels = false;
    if (plan.levels > 1) return {};
    return fail(ErrorCode::bad_argument, "{level} is for files with levels (MSFT_lod), this one has none", plan.input,
                "make them with 'lod build'");
  }
  if (!arguments.has("--level")) return {};
  plan.read = {.levels = false, .draw_level = *level};
  return check_level(plan.input, *level);
}

Result<Plan> plan_of(const Arguments& arguments) {
  Plan plan;
  plan.input = arguments.inputs[0];
  const Result<std::string> output = output_of(arguments);
  LODESTONE_TRY(output);
  plan.output = *output;
  plan.compression = compression_of(arguments);
  LODESTONE_TRY(check_output(plan.output, {plan.input}, plan.compression, OutputKind::levels));
  LODESTONE_TRY(plan_levels(arguments, plan));
  const Result<LengthRules> lengths = length_rules(arguments);
  LODESTONE_TRY(lengths);
  plan.lengths = *lengths;
  Result<VolumeRequest> volume = volume_request(arguments);
  LODESTONE_TRY(volume);
  plan.volume = std::move(*volume);
  return plan;
}

Result<Model> read(const Plan& plan, const io::ReadOptions& options, const Console& console, const Task& task) {
  Result<Model> model = read_input(plan.input, console, task, options, plan.volume);
  if (model) apply_unit(*model, plan.lengths);
  return model;
}

// All levels of the input as models.
Result<Ladder> read_levels(const Plan& plan, Model original, ConvertReport& report, const Console& console,
                           const Task& task) {
  Ladder ladder;
  ladder.original = std::move(original);
  ladder.levels.resize(1);
  for (std::size_t level = 1; level < plan.levels; ++level) {
    Result<Model> model =
        read(plan, {.levels = false, .draw_level = level}, console, task.part(1.0 / static_cast<double>(plan.levels)));
    LODESTONE_TRY(model);
    ladder.levels.emplace_back();
    ladder.levels.back().model = std::move(*model);
  }
  for (std::size_t level = 0; level < plan.levels; ++level) {
    report.file_triangles.push_back(drawn_triangles(ladder.model(level)));
  }
  return ladder;
}

std::string lines_of(const ConvertReport& report, const std::vector<std::uint64_t>& bytes, const std::string& output) {
  if (report.file_triangles.empty()) {
    return fmt::format("{}: {} triangles, {}\n", printable(output), with_separators(report.triangles),
                       human_bytes(report.bytes));
  }
  std::string out;
  for (std::size_t i = 0; i < report.files.size(); ++i) {
    out += fmt::format("{}: {} triangles, {}\n", printable(report.files[i]), with_separators(report.file_triangles[i]),
                       human_bytes(bytes[i]));
  }
  return out;
}

}  // namespace

Result<ExitCode> run_convert(const Arguments& arguments, Console& console) {
  const Result<Plan> plan = plan_of(arguments);
  LODESTONE_TRY(plan);
  ConvertReport report;
  report.input = plan->input;
  Stopwatch watch;
  const bool all = plan->levels > 0;
  Result<Model> model = read(*plan, plan->read, console, console.task().part(all ? 0.2 : 0.5, "reading"));
  LODESTONE_TRY(model);
  report.triangles = drawn_triangles(*model);
  report.warnings = model->warnings;
  const io::WriteOptions options{plan->compression, {}};
  Result<io::WriteReport> written;
  if (all) {
    const Result<Ladder> ladder =
        read_levels(*plan, std::move(*model), report, console, console.task().part(0.3, "reading levels"));
    LODESTONE_TRY(ladder);
    report.read_seconds = watch.lap();
    written = io::write_ladder(*ladder, plan->output, options, console.task().part(0.5, "writing"));
  } else {
    report.read_seconds = watch.lap();
    written = io::write_model(*model, plan->output, options, console.task().part(0.5, "writing"));
  }
  LODESTONE_TRY(written);
  console.wrote(plan->output);
  report.write_seconds = watch.lap();
  report.bytes = written->total_bytes;
  for (const auto& file : written->files) report.files.push_back(file.string());
  for (const std::string& warning : written->warnings) {
    console.note(fmt::format("{}: {}", plan->output, warning));
    report.warnings.push_back(warning);
  }
  arguments.has("--json") ? console.result(to_json(report))
                          : console.table(lines_of(report, written->level_bytes, plan->output));
  return ExitCode::done;
}

}  // namespace lodestone::app
