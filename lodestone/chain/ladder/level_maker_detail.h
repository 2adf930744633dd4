// LevelMaker: makes and measures levels of one collapse plan. Searches for the level within an error, and for the one
// whose error is in line with the levels before it.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/chain/ladder/collapse_plan_detail.h"
#include "lodestone/chain/ladder/effort.h"
#include "lodestone/chain/ladder/error_curve_detail.h"
#include "lodestone/core/level.h"
#include "lodestone/measure/distance.h"

namespace lodestone::chain::detail {

/// A prefix of the plan, made and measured.
struct MeasuredLevel {
  std::size_t prefix = 0;
  Level level;
  double simplify_seconds = 0, measure_seconds = 0;
};

/// `plan` and `reference` must outlive it.
class LevelMaker {
 public:
  LevelMaker(const CollapsePlan& plan, const measure::Reference& reference, const measure::DistanceOptions& distance,
             Effort effort);

  const CollapsePlan& plan() const { return plan_; }
  Effort effort() const { return effort_; }

  /// The level that edge collapse alone makes. Errors: cancelled.
  Result<MeasuredLevel> plain(std::size_t prefix, const Task& task) const;

  /// The same improved by its error, if that is better; else the plain one. With a goal fewer triangles within it are
  /// better. Errors: cancelled.
  Result<MeasuredLevel> with_feedback(std::size_t prefix, const Task& task, double goal = 0);

 private:
  bool is_better(const MeasuredLevel& made, const MeasuredLevel& plain, double goal) const;
  Result<MeasuredLevel> measured(MeasuredLevel cut, std::size_t prefix, Model model, Effort effort,
                                 const Task& task) const;

  const CollapsePlan& plan_;
  const measure::Reference& reference_;
  const measure::DistanceOptions distance_;
  Effort effort_;
  FitTargets targets_;
};

/// Where the search for the last error ended: the next error is larger, so it needs nothing finer.
struct Starts {
  std::size_t plain = 0;          ///< the coarsest plain prefix within the last error
  std::size_t with_feedback = 0;  ///< the prefix of the last level
};

/// The coarsest prefix found whose measured maximum is within `limit`, not finer than the last level: plain levels
/// first, within one per cent; then one improved from there on. Nothing within the limit: the plain cut where the last
/// level was. Errors: cancelled.
Result<MeasuredLevel> find_error_cut(LevelMaker& maker, Starts& starts, double limit, const Task& task);

/// A level whose error may jump, or the one that takes its place.
struct InLine {
  std::optional<MeasuredLevel>
      cut;             ///< the coarsest that is in line; none where nothing coarser than the finer level is
  bool jumps = false;  ///< the level that was asked for is out of line
};

/// `cut` itself where its error is in line with those of the finer levels (most_in_line()); else the coarsest between
/// prefix `last`, which the level before was cut at, and it that is, by bisection. Where no finer level tells what to
/// expect, one is made on the way; errors below a two-hundredth of the diagonal, and first levels that lose parts, are
/// then taken as they are. Errors: cancelled.
Result<InLine> keep_in_line(LevelMaker& maker, MeasuredLevel cut, const std::vector<CurvePoint>& finer,
                            std::size_t last, const Task& task);

}  // namespace lodestone::chain::detail
