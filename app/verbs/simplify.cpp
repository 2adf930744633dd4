#include <fmt/format.h>

#include <algorithm>

#include "app/input.h"
#include "app/options/constraints.h"
#include "app/options/numbers.h"
#include "app/options/shared_options.h"
#include "app/output/json.h"
#include "app/output/table.h"
#include "app/output/text.h"
#include "app/verbs/verbs.h"
#include "lodestone/base/stopwatch.h"
#include "lodestone/base/units.h"

namespace lodestone::app {
namespace {

// What was asked, before the model is known.
struct SimplifyPlan {
  std::vector<double> ratio;
  std::vector<std::size_t> triangles;
  std::vector<LengthArgument> error;
  LengthRules lengths;
  chain::Effort effort = chain::Effort::fast;
  ConstraintPlan constraints;
  measure::DistanceOptions distance;
  bool force = false;
};

Result<void> check_target(const Arguments& arguments) {
  const std::string remedy = "give one target: --triangles N, --ratio 10% or --error 0.1%";
  const Result<std::string> target = given_target(arguments, {"--ratio", "--triangles", "--error"}, remedy);
  LODESTONE_TRY(target);
  if (target->empty()) return fail(ErrorCode::bad_argument, "simplify needs a target", {}, remedy);
  const std::string text = arguments.text(*target);
  if (text.find(',') == std::string::npos || (*target == "--triangles" && count_in(text))) return {};
  if (const std::string meant = with_decimal_point(text); !meant.empty() && *target != "--triangles") {
    return fail(decimal_comma(*target, text, meant));
  }
  return fail(ErrorCode::bad_argument, fmt::format("{} takes one value here", *target), {},
              "'lod build' makes several levels");
}

Result<SimplifyPlan> plan_of(const Arguments& arguments) {
  LODESTONE_TRY(check_target(arguments));
  SimplifyPlan plan;
  const Result<LengthRules> lengths = length_rules(arguments);
  LODESTONE_TRY(lengths);
  plan.lengths = *lengths;
  if (arguments.has("--ratio")) {
    Result<std::vector<double>> ratio = ratio_list(arguments, "--ratio");
    LODESTONE_TRY(ratio);
    plan.ratio = std::move(*ratio);
  }
  if (arguments.has("--triangles")) {
    const Result<std::uint64_t> triangles = arguments.count("--triangles", 1);
    LODESTONE_TRY(triangles);
    plan.triangles = {*triangles};
  }
  if (arguments.has("--error")) {
    Result<std::vector<LengthArgument>> error = length_list(arguments, "--error", plan.lengths);
    LODESTONE_TRY(error);
    plan.error = std::move(*error);
  }
  Result<ConstraintPlan> constraints = constraints_of(arguments, plan.lengths);
  LODESTONE_TRY(constraints);
  plan.constraints = std::move(*constraints);
  const Result<measure::DistanceOptions> distance = distance_options(arguments);
  LODESTONE_TRY(distance);
  plan.distance = *distance;
  plan.force = arguments.has("--force");
  plan.effort = effort_of(arguments, plan.error.empty() ? chain::Effort::fast : chain::Effort::normal);
  return plan;
}

Result<chain::SimplifyModelOptions> options_for(const SimplifyPlan& plan, const Model& model, std::size_t triangles,
                                                const Console& console, std::vector<std::string>& warnings) {
  chain::SimplifyModelOptions options;
  options.effort = plan.effort;
  options.distance = plan.distance;
  options.force = plan.force;
  if (!plan.triangles.empty()) options.target_triangles = plan.triangles[0];
  if (!plan.ratio.empty()) {
    options.target_triangles =
        std::max<std::size_t>(1, static_cast<std::size_t>(plan.ratio[0] * static_cast<double>(triangles) + 0.5));
  }
  Result<chain::SimplifyConstraints> constraints =
      plan.constraints.for_model(model, options.target_triangles, warnings, console.task());
  LODESTONE_TRY(constraints);
  options.constraints = std::move(*constraints);
  if (!plan.ratio.empty()) {
    console.note(fmt::format("keeping {} of {} triangles", percent(plan.ratio[0]), with_separators(triangles)));
  } else if (!plan.error.empty()) {
    const double diagonal = bounds_of(model).diagonal();
    const Result<std::vector<double>> errors = to_model_units(plan.error, model, diagonal);
    LODESTONE_TRY(errors);
    options.max_error = errors->front();
    doubt_lengths("--error", plan.error, model, warnings);
    console.detail(fmt::format("--error {} is {} in model units (diagonal {})", plan.error[0].text,
                               short_number(options.max_error), short_number(diagonal)));
  }
  return options;
}

std::string table_of(const SimplifyReport& report) {
  const std::string unit = report.unit.empty() ? "" : " " + report.unit;
  const LevelError& error = report.error;
  Table table;
  table.add_column("", Table::Align::left);
  table.add_column("", Table::Align::left);
  const double share =
      report.triangles_in == 0 ? 0 : static_cast<double>(report.triangles) / static_cast<double>(report.triangles_in);
  table.add_row({"triangles", fmt::format("{} of {} ({})", with_separators(report.triangles),
                                          with_separators(report.triangles_in), percent(share))});
  if (report.vanished_parts) table.add_row({"parts gone", with_separators(*report.vanished_parts)});
  table.add_row({"error", fmt::format("{}{} ({} of the diagonal, {})", short_number(error.error), unit,
                                      percent(error.relative(error.error)), to_string(error.kind))});
  table.add_row({"mean error", fmt::format("{}{} ({})", short_number(error.mean_error), unit,
                                           percent(error.relative(error.mean_error)))});
  table.add_row({"method", report.method});
  table.add_row({"stopped", report.stop_reason});
  table.add_row({"file", fmt::format("{} ({})", printable(report.output), human_bytes(report.bytes))});
  table.add_row({"seconds", fmt::format("read {}, simplify {}, measure {}, write {}", seconds_text(report.read_seconds),
                                        seconds_text(report.simplify_seconds), seconds_text(report.measure_seconds),
                                        seconds_text(report.write_seconds))});
  return table.text();
}

}  // namespace

Result<ExitCode> run_simplify(const Arguments& arguments, Console& console) {
  const std::string& input = arguments.inputs.front();
  const Result<SimplifyPlan> plan = plan_of(arguments);
  LODESTONE_TRY(plan);
  if (!arguments.has("--output")) return missing_output("simplify", input);
  SimplifyReport report;
  report.input = input;
  report.output = arguments.text("--output");
  const io::Compression compression = compression_of(arguments);
  if (const Result<void> checked = check_output(report.output, {input}, compression); !checked) {
    return fail(checked.error());
  }

  const Result<VolumeRequest> volume = volume_request(arguments);
  LODESTONE_TRY(volume);
  const Result<std::uint64_t> level = arguments.count("--level", 0, 1024);
  LODESTONE_TRY(level);
  LODESTONE_TRY(check_level(input, *level));
  Stopwatch watch;
  Result<Model> model = read_input(input, console, console.task().part(0.05, "reading"),
                                   {.levels = false, .draw_level = *level}, *volume);
  LODESTONE_TRY(model);
  LODESTONE_TRY(io::check_replaced(*model, report.output));
  apply_unit(*model, plan->lengths);
  report.read_seconds = watch.lap();
  report.triangles_in = drawn_triangles(*model);
  report.unit = unit_name(model->meters_per_unit);
  report.warnings = model->warnings;

  std::vector<std::string> warnings;
  const Result<chain::SimplifyModelOptions> options =
      options_for(*plan, *model, report.triangles_in, console, warnings);
  LODESTONE_TRY(options);
  for (const std::string& warning : warnings) {
    console.note(fmt::format("{}: {}", input, warning));
    report.warnings.push_back(warning);
  }
  const Result<chain::SimplifyModelResult> result =
      chain::simplify_model(*model, *options, console.task().part(0.9, "simplifying"));
  LODESTONE_TRY(result);
  watch.lap();
  const Result<io::WriteReport> written = io::write_model(
      result->level.model, report.output, io::WriteOptions{compression, {}}, console.task().part(0.05, "writing"));
  LODESTONE_TRY(written);
  console.wrote(report.output);
  report.write_seconds = watch.lap();

  report.triangles = result->level.triangles;
  if (options->constraints.vanishes()) report.vanished_parts = result->level.vanished_parts;
  report.error = result->level.error;
  report.method = result->level.method;
  report.stop_reason = simplify::to_string(result->stop);
  report.shortfall = result->shortfall;
  report.locked = result->locked;
  report.simplify_seconds = result->simplify_seconds;
  report.measure_seconds = result->measure_seconds;
  report.bytes = written->total_bytes;
  report.peak_memory_bytes = peak_memory_bytes();
  for (const std::string& warning : written->warnings) {
    console.note(fmt::format("{}: {}", report.output, warning));
    report.warnings.push_back(warning);
  }
  arguments.has("--json") ? console.result(to_json(report)) : console.table(table_of(report));
  if (report.shortfall.empty()) return ExitCode::done;
  console.shortfall(fmt::format("{}: {}", input, report.shortfall));
  return ExitCode::fell_short;
}

}  // namespace lodestone::app
