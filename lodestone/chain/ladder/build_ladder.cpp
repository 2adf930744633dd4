// The main job: from a model to a ladder of levels, each with its error measured against the original.
//
// build_ladder():
// 1. CollapsePlan::create() collapses each drawn mesh once and merges the collapses of all meshes by error, so that
//    every plain level is a prefix of one order. measure::Reference prepares the original, in world space.
// 2. For counts and ratios (count_targets()), add_count_levels() looks up each prefix; add_count_level() makes and
//    measures the level. Where its error is out of line with those of the finer levels (keep_in_line()), the coarsest
//    level that is in line takes its place, and the ladder ends there, unless `force` is set.
//    For errors, add_error_levels() takes for each the coarsest level that find_error_cut() finds within it.
// 3. compare_pictures(), where pictures are asked for.
// simplify_model() does the same for one level. screen_coverages() gives the switch points that MSFT_lod wants.
//
// Errors never fall along a ladder (add_level()). A target that is not reached is told as a Shortfall with its cause.
// The order of collapses does not depend on the targets: a prefix makes the same plain level whatever else is asked
// for. The same bytes for any number of threads. Cost: one run of edge collapse, O(n log n), and for each level that is
// tried a replay, O(n), and a measurement, which takes longer.
#include "lodestone/chain/ladder/build_ladder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lodestone/base/stopwatch.h"
#include "lodestone/base/units.h"
#include "lodestone/chain/ladder/collapse_plan_detail.h"
#include "lodestone/chain/ladder/ladder_detail.h"
#include "lodestone/chain/ladder/level_error_detail.h"
#include "lodestone/chain/ladder/level_maker_detail.h"
#include "lodestone/core/validate.h"

namespace lodestone::chain {

using detail::CollapsePlan;
using detail::CurvePoint;
using detail::InLine;
using detail::LevelMaker;
using detail::MeasuredLevel;
using detail::Starts;
using measure::Reference;

namespace {

tl::unexpected<Error> bad(std::string what, std::string remedy) {
  return fail(ErrorCode::bad_argument, std::move(what), {}, std::move(remedy));
}

Result<void> check(const LadderOptions& options) {
  const int families =
      (options.ratios.empty() ? 0 : 1) + (options.triangles.empty() ? 0 : 1) + (options.errors.empty() ? 0 : 1);
  if (families > 1) return bad("ratios, triangle counts and errors are asked for at once", "give one of them");
  if (families == 0 && options.levels < 2) {
    return bad(fmt::format("{} levels leave nothing to make", options.levels), "ask for 2 or more, with level 0");
  }
  for (std::size_t i = 0; i < options.ratios.size(); ++i) {
    const double r = options.ratios[i];
    if (!(r > 0 && r < 1)) return bad(fmt::format("ratio {} is not between 0 and 1", r), "0.1 or 10% keeps a tenth");
    if (i > 0 && !(r < options.ratios[i - 1])) return bad("the ratios do not fall", "name the finest level first");
  }
  for (std::size_t i = 0; i < options.triangles.size(); ++i) {
    if (options.triangles[i] == 0) return bad("a level of 0 triangles is asked for", "ask for at least 1");
    if (i > 0 && options.triangles[i] >= options.triangles[i - 1]) {
      return bad("the triangle counts do not fall", "name the finest level first");
    }
  }
  for (std::size_t i = 0; i < options.errors.size(); ++i) {
    if (!(options.errors[i] > 0) || !std::isfinite(options.errors[i])) {
      return bad(fmt::format("error {} is not above 0", options.errors[i]), "give a length above 0");
    }
    if (i > 0 && !(options.errors[i] > options.errors[i - 1])) {
      return bad("the errors do not rise", "name the finest level first");
    }
  }
  return {};
}

std::string count_shortfall(const CollapsePlan& plan, std::size_t wanted, std::size_t got) {
  return fmt::format("{} triangles were asked for, {} are the fewest: {}", with_separators(wanted),
                     with_separators(got), plan.end().why);
}

// A level that collapses can't reach: what stands in the way.
Shortfall at_end(const CollapsePlan& plan, std::size_t level, std::string reason) {
  return {level, std::move(reason), ShortfallCause::nothing_to_collapse, plan.locked(), plan.end().parts};
}

// Adds a cut with its error raised to the finer levels' and accounts its time.
void add_level(LadderResult& result, MeasuredLevel cut) {
  LevelError& e = cut.level.error;
  e.error = std::max(e.measured_error, result.ladder.levels.back().error.error);
  result.simplify_seconds += cut.simplify_seconds;
  result.measure_seconds += cut.measure_seconds;
  result.ladder.levels.push_back(std::move(cut.level));
}

std::vector<CurvePoint> curve_of(const Ladder& ladder) {
  std::vector<CurvePoint> out;
  for (const Level& level : ladder.levels) out.push_back({level.triangles, level.error.measured_error});
  return out;
}

// A level that is out of line: what was asked for, and what was made for it.
struct Jump {
  std::size_t wanted = 0;  // triangles
  CurvePoint made;
  double diagonal = 0;
};

Jump jump_of(const MeasuredLevel& cut, std::size_t wanted) {
  return {wanted, {cut.level.triangles, cut.level.error.measured_error}, cut.level.error.diagonal};
}

std::string jump_shortfall(const CollapsePlan& plan, const Jump& jump, std::size_t got) {
  const bool short_of = plan.triangles_after(plan.size()) > jump.wanted;
  return fmt::format(
      "{} triangles were asked for, but errors jump below {} (to {:.2g} % of the diagonal with {}), so it ends "
      "there{}{}; `build_voxel_ladder()` `then_collapse` makes levels anew (with `texture_size` N textured ones), "
      "`force` "
      "takes "
      "them as they are",
      with_separators(jump.wanted), with_separators(got), jump.diagonal > 0 ? 100 * jump.made.error / jump.diagonal : 0,
      with_separators(jump.made.triangles), short_of ? ": " : "", short_of ? plan.end().why : "");
}

// True if a level of so many triangles differs enough from the one before to be worth writing.
bool shrinks(const LadderResult& result, std::size_t triangles) {
  return triangles * 100 <= result.ladder.levels.back().triangles * 97;
}

// True if what the first level is collapsed from is coarser than the original already: a surface made anew, or the
// original without its doubled faces.
bool starts_coarser(const LadderResult& result, const LadderOptions& options, std::size_t triangles) {
  return result.ladder.levels.size() == 1 && (options.start || shrinks(result, triangles));
}

// A level by count: its number, the triangles that are wanted, the prefix for them, and that of the level before.
struct CountStep {
  std::size_t number, wanted, prefix, last;
};

// Makes a level and adds it if its error is in line with those before it; else the coarsest that is, and the ladder
// ends. False = it ends.
Result<bool> add_count_level(LadderResult& result, LevelMaker& maker, const CountStep& step,
                             const LadderOptions& options, const Task& task) {
  Result<MeasuredLevel> cut = maker.with_feedback(step.prefix, task.part(options.force ? 1.0 : 0.7));
  LODESTONE_TRY(cut);
  if (options.force) {
    add_level(result, std::move(*cut));
    return true;
  }
  const Jump jump = jump_of(*cut, step.wanted);
  Result<InLine> kept = keep_in_line(maker, std::move(*cut), curve_of(result.ladder), step.last, task.part(0.3));
  LODESTONE_TRY(kept);
  const bool adds = kept->cut && (!kept->jumps || shrinks(result, kept->cut->level.triangles));
  if (adds) add_level(result, std::move(*kept->cut));
  if (!kept->jumps) return true;
  const std::size_t got = result.ladder.levels.back().triangles;
  result.shortfalls.push_back({step.number, jump_shortfall(maker.plan(), jump, got), ShortfallCause::error_jumps});
  return false;
}

Result<void> add_count_levels(LadderResult& result, LevelMaker& maker, const std::vector<std::size_t>& targets,
                              const LadderOptions& options, const Task& task) {
  const CollapsePlan& plan = maker.plan();
  std::size_t last = 0;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const Task part = task.part(1.0 / static_cast<double>(targets.size()), fmt::format("level {}", i + 1));
    const std::size_t prefix = plan.prefix_for(targets[i]), left = plan.triangles_after(prefix);
    const bool short_of = left > targets[i];
    const bool is_new = prefix > last || starts_coarser(result, options, left);
    if (is_new && (!short_of || shrinks(result, left))) {  // else it hardly differs from the level before
      const Result<bool> goes_on = add_count_level(result, maker, {i + 1, targets[i], prefix, last}, options, part);
      LODESTONE_TRY(goes_on);
      if (!*goes_on) break;
      last = prefix;
    } else if (!short_of) {
      result.shortfalls.push_back({i + 1, "it would not differ from the level before", ShortfallCause::no_difference});
    }
    if (!short_of) continue;
    result.shortfalls.push_back(at_end(plan, i + 1, count_shortfall(plan, targets[i], left)));
    break;
  }
  return {};
}

Result<void> add_error_levels(LadderResult& result, LevelMaker& maker, const LadderOptions& options, const Task& task) {
  const CollapsePlan& plan = maker.plan();
  std::size_t last = 0;
  Starts starts;
  for (std::size_t i = 0; i < options.errors.size(); ++i) {
    const Task part = task.part(1.0 / static_cast<double>(options.errors.size()), fmt::format("level {}", i + 1));
    Result<MeasuredLevel> cut = find_error_cut(maker, starts, options.errors[i], part);
    LODESTONE_TRY(cut);
    const bool holds = cut->level.error.measured_error <= options.errors[i];
    const bool is_new = cut->prefix > last || (holds && starts_coarser(result, options, cut->level.triangles));
    if (!is_new) {
      result.shortfalls.push_back(
          {i + 1,
           fmt::format("nothing coarser than the level before has a measured error within {:.6g}", options.errors[i]),
           ShortfallCause::error_not_reached});
      result.simplify_seconds += cut->simplify_seconds;
      result.measure_seconds += cut->measure_seconds;
      continue;
    }
    last = starts.with_feedback = cut->prefix;
    add_level(result, std::move(*cut));
    if (last == plan.size() && i + 1 < options.errors.size()) {
      result.shortfalls.push_back(at_end(plan, i + 2, "the level before is the coarsest there is: " + plan.end().why));
      break;
    }
  }
  return {};
}

// The original itself, too: from here on it counts as valid.
Result<void> check_drawn(const Model& original, const Task& task) {
  LODESTONE_TRY(validate(original, task));
  if (drawn_triangles(original) > 0) return {};
  return fail(ErrorCode::empty, "the model draws no triangle", {}, "is a scene with meshes in the file?");
}

}  // namespace

std::vector<std::size_t> detail::count_targets(const LadderOptions& options, std::size_t drawn) {
  if (!options.triangles.empty()) return options.triangles;
  std::vector<std::size_t> targets;
  const auto share_of = [&](double share) {
    return std::max<std::size_t>(1, static_cast<std::size_t>(static_cast<double>(drawn) * share + 0.5));
  };
  for (const double ratio : options.ratios) targets.push_back(share_of(ratio));
  if (!targets.empty()) return targets;
  double share = 1;
  for (std::size_t level = 1; level < options.levels; ++level) targets.push_back(share_of(share *= 0.5));
  return targets;
}

Result<void> detail::check_ladder(const Model& original, const LadderOptions& options, const Task& task) {
  LODESTONE_TRY(check(options));
  if (options.start) {
    const Result<void> ok = validate(*options.start, task);
    if (!ok) return fail(ok.error().code, ok.error().what, "start, " + ok.error().where);
  }
  return check_drawn(original, task);
}

Level detail::original_level(const Model& original, double diagonal) {
  Level level;
  level.triangles = drawn_triangles(original);
  level.method = "original";
  level.error.diagonal = diagonal;
  level.error.kind = ErrorKind::bounded;  // it is the original itself
  return level;
}

Result<void> detail::compare_pictures(LadderResult& result, const measure::ImageOptions& options, const Task& task) {
  const Stopwatch watch;
  measure::ImageOptions of_valid = options;
  of_valid.input = Input::valid;
  const auto reference = measure::ImageReference::create(result.ladder.original, of_valid, task.part(0.2));
  LODESTONE_TRY(reference);
  const std::size_t levels = result.ladder.levels.size();
  for (std::size_t i = 0; i < levels; ++i) {
    const Task part = task.part(0.8 / static_cast<double>(levels));
    const auto deviation = reference->deviation_of(result.ladder.model(i), part);
    LODESTONE_TRY(deviation);
    result.images.push_back(*deviation);
  }
  result.measure_seconds += watch.total();
  return {};
}

namespace {

// Rough shares of the time for collapsing and for preparing the reference: feedback takes far longer than both.
struct Shares {
  double collapsing, preparing;
};

Shares shares_of(Effort effort) { return effort == Effort::fast ? Shares{0.4, 0.05} : Shares{0.06, 0.02}; }

}  // namespace

Result<LadderResult> build_ladder(Model original, const LadderOptions& options, Task task) {
  LODESTONE_TRY(detail::check_ladder(original, options, task));
  const std::vector<std::size_t> targets = detail::count_targets(options, drawn_triangles(original));
  const std::size_t smallest = options.errors.empty() ? targets.back() : 1;

  const Shares shares = shares_of(options.effort);
  LadderResult result;
  result.ladder.original = std::move(original);
  const Model& model = result.ladder.original;
  const Stopwatch collapsing;
  const Result<CollapsePlan> plan =
      CollapsePlan::create(options.start ? *options.start : model, smallest, options.constraints,
                           task.part(shares.collapsing, "collapsing"));
  LODESTONE_TRY(plan);
  result.simplify_seconds = collapsing.total();
  const Stopwatch preparing;
  const Result<Reference> reference = Reference::create(model, task.part(shares.preparing, "preparing to measure"));
  LODESTONE_TRY(reference);
  result.measure_seconds = preparing.total();
  result.ladder.levels.push_back(detail::original_level(model, reference->diagonal()));
  const double left = 1 - shares.collapsing - shares.preparing;
  const Task measuring = task.part(options.image ? left - 0.15 : left, "measuring");
  LevelMaker maker(*plan, *reference, options.distance, options.effort);
  LODESTONE_TRY(options.errors.empty() ? add_count_levels(result, maker, targets, options, measuring)
                                       : add_error_levels(result, maker, options, measuring));
  if (options.image) {
    LODESTONE_TRY(detail::compare_pictures(result, *options.image, task.part(0.15, "comparing pictures")));
  }
  return result;
}

Result<SimplifyModelResult> simplify_model(const Model& original, const SimplifyModelOptions& options, Task task) {
  const bool by_count = options.target_triangles > 0, by_error = options.max_error > 0;
  if (by_count == by_error) {
    return bad(by_count ? "a triangle count and an error are asked for at once" : "no target is asked for",
               "give a triangle count, a ratio or an error");
  }
  LODESTONE_TRY(check_drawn(original, task));
  const Shares shares = shares_of(options.effort);
  const Stopwatch collapsing;
  const Result<CollapsePlan> plan =
      CollapsePlan::create(original, by_count ? options.target_triangles : 1, options.constraints,
                           task.part(shares.collapsing, "collapsing"));
  LODESTONE_TRY(plan);
  SimplifyModelResult result;
  result.simplify_seconds = collapsing.total();
  const Stopwatch preparing;
  const Result<Reference> reference = Reference::create(original, task.part(shares.preparing, "preparing to measure"));
  LODESTONE_TRY(reference);
  result.measure_seconds = preparing.total();
  const Task rest = task.part(1 - shares.collapsing - shares.preparing, "measuring");
  LevelMaker maker(*plan, *reference, options.distance, options.effort);
  Starts starts;
  Result<MeasuredLevel> cut = by_count ? maker.with_feedback(plan->prefix_for(options.target_triangles), rest)
                                       : find_error_cut(maker, starts, options.max_error, rest);
  LODESTONE_TRY(cut);
  std::string jumped;
  if (by_count && !options.force && cut->level.triangles > options.target_triangles) {
    const Jump jump = jump_of(*cut, options.target_triangles);
    Result<InLine> kept = keep_in_line(maker, std::move(*cut), {}, 0, rest);
    LODESTONE_TRY(kept);
    if (!kept->cut) {
      Result<MeasuredLevel> finest = maker.plain(0, rest);
      LODESTONE_TRY(finest);
      kept->cut = std::move(*finest);
    }
    if (kept->jumps) jumped = jump_shortfall(*plan, jump, kept->cut->level.triangles);
    *cut = std::move(*kept->cut);
  }
  result.simplify_seconds += cut->simplify_seconds;
  result.measure_seconds += cut->measure_seconds;
  result.locked = plan->locked();
  result.level = std::move(cut->level);
  const bool at_end = cut->prefix == plan->size();
  if (by_count && result.level.triangles > options.target_triangles) {
    result.stop = simplify::StopReason::no_legal_collapse;
    result.shortfall =
        jumped.empty() ? count_shortfall(*plan, options.target_triangles, result.level.triangles) : std::move(jumped);
  } else if (by_count) {
    result.stop = simplify::StopReason::reached_target;
  } else {
    result.stop = at_end ? simplify::StopReason::no_legal_collapse : simplify::StopReason::error_limit;
    if (cut->prefix == 0) {
      result.shortfall = fmt::format("no coarser mesh has a measured error within {:.6g}", options.max_error);
    }
  }
  return result;
}

std::vector<std::vector<double>> screen_coverages(const Ladder& ladder, const measure::View& view) {
  std::vector<std::vector<double>> rows;
  for (const Instance& instance : ladder.original.instances) {
    Box3d box;
    const Mesh& mesh = ladder.original.meshes[instance.mesh];
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      for (const std::uint32_t v : mesh.vertices_of(t)) box.add(instance.transform.point(mesh.position(v)));
    }
    const double radius = box.diagonal() / 2;
    std::vector<double> row;
    for (std::size_t level = 1; level < ladder.levels.size(); ++level) {
      row.push_back(
          measure::screen_coverage(radius, measure::switch_distance(ladder.levels[level].error.error, 1, view), view));
    }
    row.push_back(0);  // the coarsest never vanishes
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace lodestone::chain
