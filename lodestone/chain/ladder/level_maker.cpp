#include <utility>

#include "lodestone/base/stopwatch.h"
#include "lodestone/chain/ladder/level_error_detail.h"
#include "lodestone/chain/ladder/level_maker_detail.h"

namespace lodestone::chain::detail {

using measure::Reference;

namespace {

const char* method_of(Effort effort) {
  if (effort == Effort::fast) return "edge collapse";
  return effort == Effort::normal ? "edge collapse, weighted by its error" : "edge collapse, fitted by its error";
}

}  // namespace

LevelMaker::LevelMaker(const CollapsePlan& plan, const Reference& reference, const measure::DistanceOptions& distance,
                       Effort effort)
    : plan_(plan),
      reference_(reference),
      distance_(of_valid(distance)),
      effort_(plan.can_take_feedback() ? effort : Effort::fast) {}

Result<MeasuredLevel> LevelMaker::plain(std::size_t prefix, const Task& task) const {
  MeasuredLevel cut;
  const Stopwatch making;
  Result<Model> model = plan_.model_after(prefix, task.part(0.3));
  LODESTONE_TRY(model);
  cut.simplify_seconds = making.total();
  return measured(std::move(cut), prefix, std::move(*model), Effort::fast, task.part(0.7));
}

Result<MeasuredLevel> LevelMaker::with_feedback(std::size_t prefix, const Task& task, double goal) {
  Result<MeasuredLevel> cut = plain(prefix, task.part(effort_ == Effort::fast ? 1.0 : 0.2));
  if (!cut || effort_ == Effort::fast || prefix == 0) return cut;
  MeasuredLevel improved;
  const Stopwatch making;
  Result<Model> model = plan_.model_with_feedback(prefix, effort_, goal, targets_, task.part(0.6, "shaping"));
  LODESTONE_TRY(model);
  improved.simplify_seconds = cut->simplify_seconds + making.total();
  improved.measure_seconds = cut->measure_seconds;
  Result<MeasuredLevel> made = measured(std::move(improved), prefix, std::move(*model), effort_, task.part(0.2));
  if (!made) return made;
  if (is_better(*made, *cut, goal)) return made;
  cut->simplify_seconds = made->simplify_seconds;
  cut->measure_seconds = made->measure_seconds;
  cut->level.seconds = cut->simplify_seconds + cut->measure_seconds;
  return cut;
}

bool LevelMaker::is_better(const MeasuredLevel& made, const MeasuredLevel& plain, double goal) const {
  constexpr double kMeanSlack = 1.01;
  const LevelError &now = made.level.error, &then = plain.level.error;
  if (made.level.triangles > plain.level.triangles) return false;
  if (goal > 0 && made.level.triangles < plain.level.triangles) return now.measured_error <= goal;
  const double slack = effort_ == Effort::normal ? kMeanSlack : 1;
  const bool no_worse = now.measured_error <= then.measured_error && now.mean_error <= slack * then.mean_error;
  return no_worse && (now.measured_error < then.measured_error || now.mean_error < then.mean_error);
}

Result<MeasuredLevel> LevelMaker::measured(MeasuredLevel cut, std::size_t prefix, Model model, Effort effort,
                                           const Task& task) const {
  const Stopwatch measuring;
  const Result<measure::Distance> d = reference_.steady_distance_to(model, distance_, task);
  LODESTONE_TRY(d);
  cut.prefix = prefix;
  cut.measure_seconds += measuring.total();
  cut.level.triangles = drawn_triangles(model);
  cut.level.vanished_parts = plan_.vanished_after(prefix);
  cut.level.model = std::move(model);
  cut.level.method = method_of(effort);
  cut.level.seconds = cut.simplify_seconds + cut.measure_seconds;
  cut.level.error = level_error(*d);
  return cut;
}

}  // namespace lodestone::chain::detail
