#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "app/input.h"
#include "app/options/shared_options.h"
#include "app/output/json.h"
#include "app/output/measure_table.h"
#include "app/output/text.h"
#include "app/verbs/heat.h"
#include "app/verbs/verbs.h"
#include "lodestone/base/stopwatch.h"
#include "lodestone/base/units.h"
#include "lodestone/io/images/decode.h"
#include "lodestone/measure/attributes.h"
#include "lodestone/measure/distance.h"

namespace lodestone::app {
namespace {

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
    LODESTONE_TRY(set);
    options.uv_set = static_cast<std::uint32_t>(std::min<std::uint64_t>(*set, kNone));
  }
  return std::optional(options);
}

// What attributes and pictures need. Textures that can't be decoded are told.
Result<void> decode_textures(Model& a, Model& b, const Console& console, const Task& task) {
  std::vector<std::string> warnings;
  for (Model* model : {&a, &b}) {
    LODESTONE_TRY(io::decode_base_colors(*model, warnings, task));
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
  LODESTONE_TRY(views);
  for (const unsigned possible : {4U, 6U, 8U, 12U, 20U}) {
    if (*views == possible) options.views = static_cast<int>(possible);
  }
  if (*views == static_cast<std::uint64_t>(options.views)) return std::optional(options);
  return fail(ErrorCode::bad_argument, fmt::format("--views is {}", *views), {}, "use 4, 6, 8, 12 or 20");
}

Result<measure::ImageDeviation> compare_pictures(const Model& a, const Model& b, const measure::ImageOptions& options,
                                                 const Task& task) {
  const Result<measure::ImageReference> reference = measure::ImageReference::create(a, options, task.part(0.5));
  LODESTONE_TRY(reference);
  return reference->deviation_of(b, task.part(0.5));
}

// What both searches know of one direction.
measure::DirectedDistance joined(measure::DirectedDistance a, const measure::DirectedDistance& b) {
  if (b.max > a.max) {
    a.max = b.max;
    a.max_at = b.max_at;
  }
  a.bound = std::min(a.bound, b.bound);
  return a;
}

// Searches on until both bounds are within `length` of what was found, however long it takes. They never come out
// wider than they were.
Result<void> bound_further(measure::Distance& known, const measure::Reference& reference, const Model& b, double length,
                           measure::DistanceOptions options, const Task& task) {
  const auto is_near = [&](const measure::DirectedDistance& one) { return one.bound - one.max <= length; };
  if (!is_near(known.forward) || !is_near(known.backward)) {
    options.samples = 1;  // the figures of samples are known
    options.tolerance = 0;
    options.least_tolerance = length;
    options.queries = std::uint64_t{1} << 60;
    const Result<measure::Distance> further = reference.distance_to(b, options, task);
    LODESTONE_TRY(further);
    known.forward = joined(known.forward, further->forward);
    known.backward = joined(known.backward, further->backward);
  }
  known.max = std::max(known.forward.max, known.backward.max);
  known.bound = std::max(known.forward.bound, known.backward.bound);
  known.is_bounded = true;
  return {};
}

Result<measure::Distance> measure_distance(const Model& a, const Model& b, const measure::DistanceOptions& options,
                                           const std::vector<LengthArgument>& bounded, const Task& task) {
  const Result<measure::Reference> reference = measure::Reference::create(a, task.part(0.1));
  LODESTONE_TRY(reference);
  double length = 0;  // of --bounded
  if (!bounded.empty()) {
    const Result<std::vector<double>> lengths = to_model_units(bounded, a, reference->diagonal());
    LODESTONE_TRY(lengths);
    length = lengths->front();
    if (length < 1e-9 * reference->diagonal()) {
      return fail(ErrorCode::bad_argument, "--bounded is too small", {}, "use at least 1e-9 of the diagonal");
    }
  }
  Result<measure::Distance> distance = reference->distance_to(b, options, task.part(length > 0 ? 0.4 : 0.9));
  if (!distance || length == 0) return distance;
  LODESTONE_TRY(bound_further(*distance, *reference, b, length, options, task.part(0.5)));
  return distance;
}

struct MeasurePlan {
  LengthRules lengths;
  measure::DistanceOptions distance;
  std::vector<LengthArgument> bounded;  // one, or none without --bounded
  std::optional<measure::AttributeOptions> attributes;
  std::optional<measure::ImageOptions> image;
  std::string heat;  // file to write, empty without --heat
};

Result<MeasurePlan> plan_of(const Arguments& arguments) {
  MeasurePlan plan;
  const Result<LengthRules> lengths = length_rules(arguments);
  LODESTONE_TRY(lengths);
  plan.lengths = *lengths;
  const Result<measure::DistanceOptions> distance = distance_options(arguments);
  LODESTONE_TRY(distance);
  plan.distance = *distance;
  if (arguments.has("--bounded")) {
    Result<std::vector<LengthArgument>> bounded = length_list(arguments, "--bounded", plan.lengths);
    LODESTONE_TRY(bounded);
    if (bounded->size() > 1) return fail(ErrorCode::bad_argument, "--bounded takes one value");
    plan.bounded = std::move(*bounded);
  }
  const auto attributes = attribute_options(arguments, plan.distance);
  LODESTONE_TRY(attributes);
  plan.attributes = *attributes;
  const auto image = image_options(arguments);
  LODESTONE_TRY(image);
  plan.image = *image;
  if (arguments.has("--heat")) {
    plan.heat = arguments.text("--heat");
    LODESTONE_TRY(check_heat_output(plan.heat, arguments.inputs));
  }
  return plan;
}

// Fills in all figures. Each kind of them has a share of the progress.
Result<void> measure_models(MeasureReport& report, Model& a, Model& b, const MeasurePlan& plan, Console& console) {
  const Task task = console.task().part(0.7);
  const double extras = (plan.attributes ? 0.4 : 0) + (plan.image ? 0.2 : 0) + (plan.heat.empty() ? 0 : 0.2);
  const Result<measure::Distance> distance =
      measure_distance(a, b, plan.distance, plan.bounded, task.part(0.95 - extras, "measuring"));
  LODESTONE_TRY(distance);
  report.distance = *distance;
  const Task counting = task.part(0.05, "counting");
  const Result<measure::Shape> shape_a = measure::shape_of(a, counting);
  const Result<measure::Shape> shape_b = shape_a ? measure::shape_of(b, counting) : shape_a;
  LODESTONE_TRY(shape_b);
  report.shape_a = *shape_a;
  report.shape_b = *shape_b;
  if (plan.attributes || plan.image) {
    LODESTONE_TRY(decode_textures(a, b, console, task));
  }
  if (plan.attributes) {
    const auto found = measure::attribute_deviation(a, b, *plan.attributes, task.part(0.4, "measuring attributes"));
    LODESTONE_TRY(found);
    report.attributes = *found;
  }
  if (plan.image) {
    const auto found = compare_pictures(a, b, *plan.image, task.part(0.2, "drawing"));
    LODESTONE_TRY(found);
    report.image = *found;
  }
  if (!plan.heat.empty()) {
    const Result<HeatReport> heat = write_heat(a, b, plan.heat, console, task.part(0.2, "colouring"));
    LODESTONE_TRY(heat);
    report.heat = *heat;
  }
  return {};
}

}  // namespace

Result<ExitCode> run_measure(const Arguments& arguments, Console& console) {
  const Result<MeasurePlan> plan = plan_of(arguments);
  LODESTONE_TRY(plan);
  Stopwatch watch;
  MeasureReport report;
  report.a = arguments.inputs[0];
  report.b = arguments.inputs[1];
  Result<Model> a = read_input(report.a, console, console.task().part(0.15, "reading A"));
  LODESTONE_TRY(a);
  Result<Model> b = read_input(report.b, console, console.task().part(0.15, "reading B"));
  LODESTONE_TRY(b);
  apply_unit(*a, plan->lengths);
  report.unit = unit_name(a->meters_per_unit);
  if (!plan->heat.empty()) {
    for (const Model* model : {&*a, &*b}) {
      LODESTONE_TRY(io::check_replaced(*model, plan->heat));
    }
  }
  LODESTONE_TRY(measure_models(report, *a, *b, *plan, console));
  report.seconds = watch.total();
  arguments.has("--json") ? console.result(to_json(report)) : console.table(table_of(report));
  return ExitCode::done;
}

}  // namespace lodestone::app
