// Two searches along a collapse plan: for the coarsest level within an error, and for the coarsest level whose error is
// in line with those of the finer levels.
//
// Both use Search, which bisects between a prefix that is good enough and one that is not, on the logarithm of the
// triangle count (next()). Each probe is replayed and measured (run()).
// - find_error_cut() tries the end of the plan first, then bisects until the bracket is within one per cent of the
//   triangles. With an effort above fast, fewest_with_feedback() then looks for an improved level with as few triangles
//   as the error allows: from a coarser prefix, else from the one found, else from that of the last level.
// - keep_in_line() compares an error with what the finer levels lead one to expect (most_in_line()). Where none of them
//   tells anything, curve_before() measures a level in between. A level that is out of line is replaced by the coarsest
//   one that is in line, with a bracket within three per cent.
//
// Measured errors need not rise along the plan, so what is found is the coarsest of the probes, not of all prefixes.
// A search never returns a prefix finer than the last level's. The same for any number of threads. O(log n) probes,
// each of which is measured.
#include <algorithm>
#include <cmath>
#include <utility>

#include "lodestone/chain/ladder/level_maker_detail.h"

namespace lodestone::chain::detail {

namespace {

// Bisection for the coarsest plain level that is good enough: between `good`, a prefix that is, or is taken to be, and
// `bad`, one that is not, until the bracket is within `nearness`. `best` is empty where no probe was good enough.
struct Search {
  std::size_t good, bad;
  double nearness;
  std::optional<MeasuredLevel> best;
  double simplify_seconds = 0, measure_seconds = 0;

  // The cut becomes the best, whatever its error.
  Result<void> take(Result<MeasuredLevel> cut) {
    LODESTONE_TRY(cut);
    count(*cut);
    best = std::move(*cut);
    return {};
  }

  void count(const MeasuredLevel& cut) {
    simplify_seconds += cut.simplify_seconds;
    measure_seconds += cut.measure_seconds;
  }

  // The best level, with the time of everything that was tried.
  MeasuredLevel finish() {
    MeasuredLevel cut = std::move(*best);
    cut.simplify_seconds = simplify_seconds;
    cut.measure_seconds = measure_seconds;
    cut.level.seconds = simplify_seconds + measure_seconds;
    return cut;
  }

  // The prefix to look at next; 0 when the bracket is narrow enough.
  std::size_t next(const CollapsePlan& plan) const {
    const auto fine = static_cast<double>(plan.triangles_after(good));
    const auto coarse = static_cast<double>(plan.triangles_after(std::min(plan.size(), bad)));
    if (bad <= good + 1 || fine - coarse <= nearness * coarse) return 0;
    return std::clamp(plan.prefix_for(static_cast<std::size_t>(std::sqrt(fine * coarse))), good + 1, bad - 1);
  }

  // `within` says whether a cut is good enough; `first`: the prefix to look at first, 0 = the middle.
  template <class Within>
  Result<void> run(const LevelMaker& maker, std::size_t first, Within&& within, const Task& task) {
    for (std::size_t prefix = first != 0 ? first : next(maker.plan()); prefix != 0; prefix = next(maker.plan())) {
      Result<MeasuredLevel> cut = maker.plain(prefix, task.part(0.1));
      LODESTONE_TRY(cut);
      if (within(*cut)) {
        good = prefix;
        LODESTONE_TRY(take(std::move(cut)));
      } else {
        count(*cut);
        bad = prefix;
      }
    }
    return {};
  }
};

// Improves a level to as few triangles as `limit` allows, fewer than the last level has (`last` is its prefix). A level
// somewhat coarser than the plain one is tried first: fitting brings it within the limit, and its triangles are better
// than those of collapses that were limited one by one.
Result<void> fewest_with_feedback(LevelMaker& maker, Search& search, std::size_t last, double limit, const Task& task) {
  constexpr double kCoarserStart = 0.8;
  const CollapsePlan& plan = maker.plan();
  const std::size_t plain = search.good;
  const auto fewer = static_cast<std::size_t>(kCoarserStart * static_cast<double>(plan.triangles_after(plain)));
  std::vector<std::size_t> starts{std::max(plain, plan.prefix_for(fewer)), plain, std::max(plain, last)};
  starts.erase(std::unique(starts.begin(), starts.end()), starts.end());
  for (const std::size_t start : starts) {
    Result<MeasuredLevel> cut = maker.with_feedback(start, task.part(0.3), limit);
    LODESTONE_TRY(cut);
    // A level with fewer triangles than the plan's end does not count as the end.
    const std::size_t reached = std::min(plan.prefix_for(cut->level.triangles), plan.size() - 1);
    if (cut->level.error.measured_error <= limit && std::max(start, reached) > last) {
      cut->prefix = std::max(start, reached);
      search.good = cut->prefix;
      return search.take(std::move(cut));
    }
    search.count(*cut);
  }
  return {};
}

}  // namespace

Result<MeasuredLevel> find_error_cut(LevelMaker& maker, Starts& starts, double limit, const Task& task) {
  constexpr double kNear = 0.01;
  const CollapsePlan& plan = maker.plan();
  const bool shapes = maker.effort() != Effort::fast;
  const Task probes = task.part(shapes ? 0.3 : 0.9, "searching");
  Search search{starts.plain, plan.size() + 1, kNear, {}};
  const auto within = [&](const MeasuredLevel& cut) { return cut.level.error.measured_error <= limit; };
  LODESTONE_TRY(search.run(maker, plan.size(), within, probes));
  starts.plain = search.good;
  if (shapes && search.good < plan.size()) {
    const Task shaping = task.part(0.7, "shaping");
    if (const Result<void> ok = fewest_with_feedback(maker, search, starts.with_feedback, limit, shaping); !ok)
      return fail(ok.error());
  }
  if (search.good < starts.with_feedback)
    search.good = starts.with_feedback;  // plain levels are not within its error: it was improved
  if (!search.best || search.best->prefix != search.good) {
    LODESTONE_TRY(search.take(maker.plain(search.good, task)));
  }
  return search.finish();
}

namespace {

// The curve of errors that a level is compared with. Where no finer level tells anything (tells()), a level half way
// between, by the logarithm of the triangle count, is measured and counted with at least the smallest error that tells.
// Left out for errors below a two-hundredth of the diagonal, and where parts may vanish.
Result<std::vector<CurvePoint>> curve_before(const LevelMaker& maker, const MeasuredLevel& cut,
                                             std::vector<CurvePoint> finer, const Task& task) {
  constexpr double kSmall = 0.005;
  if (maker.plan().prunes()) return finer;  // the first part that vanishes is a jump by its nature
  const LevelError& e = cut.level.error;
  const auto knows = [&](const CurvePoint& p) { return tells(p, e.diagonal); };
  if (std::any_of(finer.begin(), finer.end(), knows) || e.measured_error <= kSmall * e.diagonal) return finer;
  const auto start = static_cast<double>(maker.plan().triangles_after(0));
  const auto between = static_cast<std::size_t>(std::sqrt(start * static_cast<double>(cut.level.triangles)));
  const Result<MeasuredLevel> probe = maker.plain(maker.plan().prefix_for(between), task);
  LODESTONE_TRY(probe);
  const double told = std::max(probe->level.error.measured_error, kLeastTelling * e.diagonal);
  finer.push_back({probe->level.triangles, told});
  return finer;
}

}  // namespace

Result<InLine> keep_in_line(LevelMaker& maker, MeasuredLevel cut, const std::vector<CurvePoint>& finer,
                            std::size_t last, const Task& task) {
  constexpr double kNear = 0.03;
  const Result<std::vector<CurvePoint>> curve = curve_before(maker, cut, finer, task.part(0.1));
  LODESTONE_TRY(curve);
  const auto in_line = [&](const MeasuredLevel& c) {
    const LevelError& e = c.level.error;
    return e.measured_error <= most_in_line(*curve, c.level.triangles, e.diagonal, maker.plan().prunes());
  };
  InLine out;
  if (in_line(cut)) {
    out.cut = std::move(cut);
    return out;
  }
  out.jumps = true;
  Search search{last, cut.prefix, kNear, {}};
  search.count(cut);
  LODESTONE_TRY(search.run(maker, 0, in_line, task.part(0.6)));
  if (!search.best) return out;
  Result<MeasuredLevel> improved = maker.with_feedback(search.good, task.part(0.3));
  LODESTONE_TRY(improved);
  if (in_line(*improved)) {
    LODESTONE_TRY(search.take(std::move(improved)));
  } else {
    search.count(*improved);
  }
  out.cut = search.finish();
  return out;
}

}  // namespace lodestone::chain::detail
