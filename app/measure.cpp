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

std::string shape_table(const MeasureReport& report) {
  Table table;
  table.add_column("shape", Table::Align::left);
  for (const char* title : {"triangles", "pieces", "closed", "manifold", "genus", "open edges"})
    table.add_column(title);
  const std::string& unit = report.unit;
  table.add_column(unit.empty() ? "area" : "area (" + unit + "^2)");
  table.add_column(unit.empty() ? "volume" : "volume (" + unit + "^3)");
  const auto row = [&](const char* name, const measure::Shape& shape) {
    const Topology& t = shape.topology;
    table.add_row({name, with_separators(t.triangles), with_separators(t.components), t.closed ? "yes" : "no",
                   t.manifold ? "yes" : "no", shape.genus ? fmt::format("{}", *shape.genus) : "-",
                   with_separators(t.boundary_edges), short_number(shape.area),
                   t.closed ? short_number(shape.volume) : "-"});
  };
  row("A", report.shape_a);
  row("B", report.shape_b);
  const auto kept = [](double a, double b) { return a != 0 ? percent(b / a) : std::string("-"); };
  const bool closed = report.shape_a.topology.closed && report.shape_b.topology.closed;
  table.add_row({"B of A",
                 kept(static_cast<double>(report.shape_a.topology.triangles),
                      static_cast<double>(report.shape_b.topology.triangles)),
                 "", "", "", "", "", kept(report.shape_a.area, report.shape_b.area),
                 closed ? kept(report.shape_a.volume, report.shape_b.volume) : "-"});
  return "\n" + table.text();
}

std::string table_of(const measure::ImageDeviation& image) {
  Table table;
  table.add_column("pictures", Table::Align::left);
  for (const char* title : {"silhouette, mean", "worst", "farthest", "PSNR", "SSIM"}) table.add_column(title);
  const auto row = [&](const char* name, bool first, double psnr, double ssim) {
    table.add_row({name, first ? percent(image.silhouette_mean) : "", first ? percent(image.silhouette_max) : "",
                   first ? fmt::format("{:.1f} px", image.screen_max_px) : "", fmt::format("{:.1f} dB", psnr),
                   fmt::format("{:.4f}", ssim)});
  };
  row("shading", true, image.shading_psnr, image.shading_ssim);
  if (image.has_color) row("colours", false, image.color_psnr, image.color_ssim);
  return fmt::format("\n{}\n{} views, {} x {} pixels\n", table.text(), image.views, image.size_px, image.size_px);
}

std::string table_of(const MeasureReport& report) {
  const measure::Distance& d = report.distance;
  Table table;
  table.add_column(report.unit.empty() ? "distance" : "distance (" + report.unit + ")", Table::Align::left);
  for (const char* title : {"max", "found", "at most", "mean", "median", "95 %", "rms", "normals"})
    table.add_column(title);
  const auto degrees = [](double value) { return fmt::format("{:.2f} deg", value); };
  const auto row = [&](const char* name, const measure::DirectedDistance& one) {
    table.add_row({name, short_number(one.sampled_max), short_number(one.max), short_number(one.bound),
                   short_number(one.mean), short_number(one.median), short_number(one.percentile_95),
                   short_number(one.rms), degrees(one.normal_degrees)});
  };
  row("A to B", d.forward);
  row("B to A", d.backward);
  table.add_row({"both", short_number(d.sampled_max), short_number(d.max), short_number(d.bound), short_number(d.mean),
                 "", "", short_number(d.rms), degrees(d.normal_degrees)});
  table.add_row({"of the diagonal", percent(d.relative(d.sampled_max)), percent(d.relative(d.max)),
                 percent(d.relative(d.bound)), percent(d.relative(d.mean)), "", "", percent(d.relative(d.rms)), ""});
  const std::string attributes = report.attributes ? table_of(*report.attributes) : "";
  const std::string image = report.image ? table_of(*report.image) : "";
  return table.text() + shape_table(report) + attributes + image +
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

// What attributes and pictures need. Textures that can't be decoded are told.
Result<void> decode_textures(Model& a, Model& b, const Console& console, const Task& task) {
  std::vector<std::string> warnings;
  for (Model* model : {&a, &b}) {
    if (Result<void> decoded = io::decode_base_colors(*model, warnings, task); !decoded) return decoded;
  }
  for (const std::string& warning : warnings) console.note(warning);
  return {};
}

// The options of the pictures; nothing without --image.
Result<std::optional<measure::ImageOptions>> image_options(const Arguments& arguments) {
  if (!arguments.has("--image")) {
    if (!arguments.has("--views")) return std::optional<measure::ImageOptions>();
    return fail(ErrorCode::bad_argument, "--views needs --image", {}, "add --image");
  }
  measure::ImageOptions options;
  const Result<std::uint64_t> views = arguments.count("--views");
  if (!views) return fail(views.error());
  for (const unsigned possible : {4U, 6U, 8U, 12U, 20U}) {
    if (*views == possible) options.views = static_cast<int>(possible);
  }
  if (*views == static_cast<std::uint64_t>(options.views)) return std::optional(options);
  return fail(ErrorCode::bad_argument, fmt::format("--views is {}", *views), {}, "use 4, 6, 8, 12 or 20");
}

Result<measure::ImageDeviation> compare_pictures(const Model& a, const Model& b, const measure::ImageOptions& options,
                                                 const Task& task) {
  const Result<measure::ImageReference> reference = measure::ImageReference::create(a, options, task.part(0.5));
  if (!reference) return fail(reference.error());
  return reference->deviation_of(b, task.part(0.5));
}

// --bounded: until the bound is within that length, whatever it takes.
Result<measure::Distance> measure_distance(const Model& a, const Model& b, measure::DistanceOptions options,
                                           const std::vector<LengthArgument>& bounded, const Task& task) {
  const Result<measure::Reference> reference = measure::Reference::create(a, task.part(0.1));
  if (!reference) return fail(reference.error());
  if (!bounded.empty()) {
    const Result<std::vector<double>> length = to_model_units(bounded, a, reference->diagonal());
    if (!length) return fail(length.error());
    if (length->front() < 1e-9 * reference->diagonal()) {
      return fail(ErrorCode::bad_argument, "--bounded is too small", {}, "use at least 1e-9 of the diagonal");
    }
    options.tolerance = 0;
    options.least_tolerance = length->front();
    options.queries = std::uint64_t{1} << 60;
  }
  return reference->distance_to(b, options, task);
}

struct MeasurePlan {
  LengthRules lengths;
  measure::DistanceOptions distance;
  std::vector<LengthArgument> bounded;  // one, or none without --bounded
  std::optional<measure::AttributeOptions> attributes;
  std::optional<measure::ImageOptions> image;
};

Result<MeasurePlan> plan_of(const Arguments& arguments) {
  MeasurePlan plan;
  const Result<LengthRules> lengths = length_rules(arguments);
  if (!lengths) return fail(lengths.error());
  plan.lengths = *lengths;
  const Result<measure::DistanceOptions> distance = distance_options(arguments);
  if (!distance) return fail(distance.error());
  plan.distance = *distance;
  if (arguments.has("--bounded")) {
    Result<std::vector<LengthArgument>> bounded = length_list(arguments, "--bounded", plan.lengths);
    if (!bounded) return fail(bounded.error());
    if (bounded->size() > 1) return fail(ErrorCode::bad_argument, "--bounded takes one value");
    plan.bounded = std::move(*bounded);
  }
  const auto attributes = attribute_options(arguments, plan.distance);
  if (!attributes) return fail(attributes.error());
  plan.attributes = *attributes;
  const auto image = image_options(arguments);
  if (!image) return fail(image.error());
  plan.image = *image;
  return plan;
}

// Fills in all figures. Each kind of them has a share of the progress.
Result<void> measure_models(MeasureReport& report, Model& a, Model& b, const MeasurePlan& plan,
                            const Console& console) {
  const Task task = console.task().part(0.7);
  const double extras = (plan.attributes ? 0.4 : 0) + (plan.image ? 0.2 : 0);
  const Result<measure::Distance> distance =
      measure_distance(a, b, plan.distance, plan.bounded, task.part(0.95 - extras, "measuring"));
  if (!distance) return fail(distance.error());
  report.distance = *distance;
  const Task counting = task.part(0.05, "counting");
  const Result<measure::Shape> shape_a = measure::shape_of(a, counting);
  const Result<measure::Shape> shape_b = shape_a ? measure::shape_of(b, counting) : shape_a;
  if (!shape_b) return fail(shape_b.error());
  report.shape_a = *shape_a;
  report.shape_b = *shape_b;
  if (plan.attributes || plan.image) {
    if (Result<void> decoded = decode_textures(a, b, console, task); !decoded) return decoded;
  }
  if (plan.attributes) {
    const auto found = measure::attribute_deviation(a, b, *plan.attributes, task.part(0.4, "measuring attributes"));
    if (!found) return fail(found.error());
    report.attributes = *found;
  }
  if (plan.image) {
    const auto found = compare_pictures(a, b, *plan.image, task.part(0.2, "drawing"));
    if (!found) return fail(found.error());
    report.image = *found;
  }
  return {};
}

}  // namespace

Result<ExitCode> run_measure(const Arguments& arguments, Console& console) {
  const Result<MeasurePlan> plan = plan_of(arguments);
  if (!plan) return fail(plan.error());
  Stopwatch watch;
  MeasureReport report;
  report.a = arguments.inputs[0];
  report.b = arguments.inputs[1];
  Result<Model> a = read_input(report.a, console, console.task().part(0.15, "reading A"));
  if (!a) return fail(a.error());
  Result<Model> b = read_input(report.b, console, console.task().part(0.15, "reading B"));
  if (!b) return fail(b.error());
  apply_unit(*a, plan->lengths);
  report.unit = unit_name(a->meters_per_unit);
  if (const Result<void> measured = measure_models(report, *a, *b, *plan, console); !measured) {
    return fail(measured.error());
  }
  report.seconds = watch.total();
  console.result(arguments.has("--json") ? to_json(report) : table_of(report));
  return ExitCode::done;
}

}  // namespace lodestone::app
