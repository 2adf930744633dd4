#include "lodestone/measure/distance.h"

#include <fmt/format.h>

#include "app/input.h"
#include "app/json.h"
#include "app/shared_options.h"
#include "app/table.h"
#include "app/text.h"
#include "app/verbs.h"
#include "lodestone/base/stopwatch.h"
#include "lodestone/base/units.h"

namespace lodestone::app {
namespace {

std::string table_of(const MeasureReport& report) {
  const measure::Distance& d = report.distance;
  Table table;
  table.add_column(report.unit.empty() ? "distance" : "distance (" + report.unit + ")", Table::Align::left);
  for (const char* title : {"max", "sharpened max", "mean", "rms", "normals"}) table.add_column(title);
  const auto degrees = [](double value) { return fmt::format("{:.2f} deg", value); };
  const auto row = [&](const char* name, const measure::DirectedDistance& one) {
    table.add_row({name, short_number(one.sampled_max), short_number(one.max), short_number(one.mean),
                   short_number(one.rms), degrees(one.normal_degrees)});
  };
  row("A to B", d.forward);
  row("B to A", d.backward);
  table.add_row({"both", short_number(d.sampled_max), short_number(d.max), short_number(d.mean), short_number(d.rms),
                 degrees(d.normal_degrees)});
  table.add_row({"of the diagonal", percent(d.relative(d.sampled_max)), percent(d.relative(d.max)),
                 percent(d.relative(d.mean)), percent(d.relative(d.rms)), ""});
  return table.text() + fmt::format("\n{} samples a direction, diagonal of A {}, {} s\n", with_separators(d.samples),
                                    short_number(d.diagonal), seconds_text(report.seconds));
}

}  // namespace

Result<ExitCode> run_measure(const Arguments& arguments, Console& console) {
  const Result<measure::DistanceOptions> options = distance_options(arguments);
  if (!options) return fail(options.error());
  const Result<LengthRules> lengths = length_rules(arguments);
  if (!lengths) return fail(lengths.error());

  Stopwatch watch;
  MeasureReport report;
  report.a = arguments.inputs[0];
  report.b = arguments.inputs[1];
  Result<Model> a = read_input(report.a, console, console.task().part(0.15, "reading A"));
  if (!a) return fail(a.error());
  const Result<Model> b = read_input(report.b, console, console.task().part(0.15, "reading B"));
  if (!b) return fail(b.error());
  apply_unit(*a, *lengths);
  report.unit = unit_name(a->meters_per_unit);
  const Result<measure::Distance> distance = measure::distance(*a, *b, *options, console.task().part(0.7, "measuring"));
  if (!distance) return fail(distance.error());
  report.distance = *distance;
  report.seconds = watch.total();
  console.result(arguments.has("--json") ? to_json(report) : table_of(report));
  return ExitCode::done;
}

}  // namespace lodestone::app
