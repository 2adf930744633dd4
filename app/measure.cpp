#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "app/input.h"
#include "app/json.h"
#include "app/shared_options.h"
#include "app/table.h"
#include "app/text.h"
#include "app/verbs.h"
#include "lodestone/base/stopwatch.h"
#include "lodestone/base/units.h"
#include "lodestone/io/image_decode.h"
#include "lodestone/measure/attributes.h"
#include "lodestone/measure/distance.h"

namespace lodestone::app {
namespace {

std::string table_of(const measure::Attributes& attributes) {
  Table table;
  table.add_column("attribute", Table::Align::left);
  for (const char* title : {"mean", "rms", "median", "95 %", "max", "compared"}) table.add_column(title);
  const auto row = [&](const std::string& name, const measure::Deviation& d) {
    table.add_row({name, short_number(d.mean), short_number(d.rms), short_number(d.median),
                   short_number(d.percentile_95), short_number(d.max), percent(d.share)});
  };
  row("normals (deg)", attributes.normal.both);
  for (const measure::UvFigure& uv : attributes.uv) {
    const measure::Deviation& d = uv.distance.both;
    row(fmt::format("UV set {}", uv.set), d);
    table.add_row({"  of its diagonal", percent(uv.relative(d.mean)), percent(uv.relative(d.rms)),
                   percent(uv.relative(d.median)), percent(uv.relative(d.percentile_95)), percent(uv.relative(d.max)),
                   ""});
  }
  if (attributes.color) row("vertex colours", attributes.color->both);
  if (attributes.look) row("colours as shown", attributes.look->both);
  std::string text = "\n" + table.text();
  for (const std::string& note : attributes.notes) text += fmt::format("\n{}\n", printable(note));
  return text;
}

std::string table_of(const MeasureReport& report) {
  const measure::Distance& d = report.distance;
  Table table;
  table.add_column(report.unit.empty() ? "distance" : "distance (" + report.unit + ")", Table::Align::left);
  for (const char* title : {"max", "sharpened max", "at most", "mean", "rms", "normals"}) table.add_column(title);
  const auto degrees = [](double value) { return fmt::format("{:.2f} deg", value); };
  const auto row = [&](const char* name, const measure::DirectedDistance& one) {
    table.add_row({name, short_number(one.sampled_max), short_number(one.max), short_number(one.bound),
                   short_number(one.mean), short_number(one.rms), degrees(one.normal_degrees)});
  };
  row("A to B", d.forward);
  row("B to A", d.backward);
  table.add_row({"both", short_number(d.sampled_max), short_number(d.max), short_number(d.bound), short_number(d.mean),
                 short_number(d.rms), degrees(d.normal_degrees)});
  table.add_row({"of the diagonal", percent(d.relative(d.sampled_max)), percent(d.relative(d.max)),
                 percent(d.relative(d.bound)), percent(d.relative(d.mean)), percent(d.relative(d.rms)), ""});
  const std::string attributes = report.attributes ? table_of(*report.attributes) : "";
  return table.text() + attributes +
         fmt::format("\n{} samples a direction, diagonal of A {}, {} s\n", with_separators(d.samples),
                     short_number(d.diagonal), seconds_text(report.seconds));
}

// The options of the second table; nothing without --attributes.
Result<std::optional<measure::AttributeOptions>> attribute_options(const Arguments& arguments,
                                                                   const measure::DistanceOptions& distance) {
  if (!arguments.has("--attributes")) {
    if (!arguments.has("--uv-set")) return std::optional<measure::AttributeOptions>();
    return fail(ErrorCode::bad_argument, "--uv-set needs --attributes", {}, "add --attributes");
  }
  measure::AttributeOptions options;
  options.samples = distance.samples;
  options.seed = distance.seed;
  if (arguments.has("--uv-set")) {
    const Result<std::uint64_t> set = arguments.count("--uv-set");
    if (!set) return fail(set.error());
    options.uv_set = static_cast<std::uint32_t>(std::min<std::uint64_t>(*set, kNone));
  }
  return std::optional(options);
}

Result<measure::Attributes> measure_attributes(Model& a, Model& b, const measure::AttributeOptions& options,
                                               const Console& console, const Task& task) {
  std::vector<std::string> warnings;
  for (Model* model : {&a, &b}) {
    const Result<void> decoded = io::decode_base_colors(*model, warnings, task);
    if (!decoded) return fail(decoded.error());
  }
  for (const std::string& warning : warnings) console.note(warning);
  return measure::attribute_deviation(a, b, options, task);
}

}  // namespace

Result<ExitCode> run_measure(const Arguments& arguments, Console& console) {
  const Result<measure::DistanceOptions> options = distance_options(arguments);
  if (!options) return fail(options.error());
  const auto attributes = attribute_options(arguments, *options);
  if (!attributes) return fail(attributes.error());
  const Result<LengthRules> lengths = length_rules(arguments);
  if (!lengths) return fail(lengths.error());

  Stopwatch watch;
  MeasureReport report;
  report.a = arguments.inputs[0];
  report.b = arguments.inputs[1];
  Result<Model> a = read_input(report.a, console, console.task().part(0.15, "reading A"));
  if (!a) return fail(a.error());
  Result<Model> b = read_input(report.b, console, console.task().part(0.15, "reading B"));
  if (!b) return fail(b.error());
  apply_unit(*a, *lengths);
  report.unit = unit_name(a->meters_per_unit);
  const double share = *attributes ? 0.3 : 0.7;
  const Result<measure::Distance> distance =
      measure::distance(*a, *b, *options, console.task().part(share, "measuring"));
  if (!distance) return fail(distance.error());
  report.distance = *distance;
  if (*attributes) {
    const Result<measure::Attributes> found =
        measure_attributes(*a, *b, **attributes, console, console.task().part(0.4, "measuring attributes"));
    if (!found) return fail(found.error());
    report.attributes = *found;
  }
  report.seconds = watch.total();
  console.result(arguments.has("--json") ? to_json(report) : table_of(report));
  return ExitCode::done;
}

}  // namespace lodestone::app
