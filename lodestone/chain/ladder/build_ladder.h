// The main job: a model in, a ladder of levels out, each measured against the original, targets met by measurement.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/chain/ladder/constraints.h"
#include "lodestone/chain/ladder/effort.h"
#include "lodestone/core/level.h"
#include "lodestone/measure/distance.h"
#include "lodestone/measure/image.h"
#include "lodestone/measure/screen.h"
#include "lodestone/simplify/collapse/edge_collapse.h"

namespace lodestone::chain {

/// What the coarser levels shall be. At most one of `ratios`, `triangles`, `errors` is filled; when none is, `levels`
/// rules: level 0 and levels - 1 coarser ones, each with half the triangles of the one before.
struct LadderOptions {
  std::size_t levels = 5;              ///< with level 0; at least 2
  std::vector<double> ratios;          ///< share of the drawn triangles kept, (0, 1), one a coarser level, falling
  std::vector<std::size_t> triangles;  ///< drawn triangles, one a coarser level, falling
  std::vector<double> errors;          ///< measured maximum allowed, model units, one a coarser level, rising:
                                       ///< the coarsest mesh found within it, by bisection over one run's log
  SimplifyConstraints constraints;     ///< where the model matters more, what must not move
  Effort effort = Effort::fast;        ///< how much work each level is worth
  measure::DistanceOptions distance;   ///< samples and seed of the measurement
  /// With counts and ratios: levels are written however far their errors jump. Without, a ladder ends where an error is
  /// above twice what the curve of the finer levels leads one to expect, as it is when nothing legal is left.
  bool force = false;
  /// What the coarser levels are collapsed from in place of the original, which they are measured against all the same:
  /// a surface made from it. It has one instance of one mesh, as the original must have.
  std::optional<Model> start;
  /// Compare pictures of each level as well. The original's textures must be decoded (io::decode_base_colors()).
  std::optional<measure::ImageOptions> image;
};

/// Why a level is not what was asked.
enum class ShortfallCause {
  nothing_to_collapse,    ///< no legal collapse is left: `locked` and `parts` say what stands in the way
  error_jumps,            ///< fewer triangles have errors out of line with those of the finer levels
  no_difference,          ///< it would be the level before
  error_not_reached,      ///< no coarser mesh has a measured error within what was allowed
  not_reached_by_voxels,  ///< no resolution gives what was asked
};

/// A level that is not what was asked.
struct Shortfall {
  std::size_t level = 0;
  std::string reason;  ///< plain words: what was asked, what was got, what was locked; settings that help in backquotes
  ShortfallCause cause = ShortfallCause::nothing_to_collapse;
  simplify::LockCounts locked{};  ///< vertices that cannot move, where collapses have come to their end
  std::size_t parts = 0;          ///< drawn pieces that keep a few triangles each, where they are many of what is left
};

struct LadderResult {
  Ladder ladder;
  std::vector<Shortfall> shortfalls;            ///< empty = every target was reached
  std::vector<std::string> warnings;            ///< what had to be assumed, what vanished; plain words
  std::vector<measure::ImageDeviation> images;  ///< one a level, with LadderOptions::image; else empty
  double simplify_seconds = 0, measure_seconds = 0;
};

/// Runs edge collapse once on every mesh, merges the collapses by error times the largest instance scale, cuts the
/// levels from that one record and measures each in world space. A ladder that can't shrink further ends early, with a
/// shortfall. With an effort above fast each level is improved by its own measured error, and kept only if neither its
/// maximum nor its mean (of normal: by more than a hundredth; not for errors, which are about maxima) is above the
/// plain level's; it is no prefix of the record then, which its method tells, and an error is looked for with improved
/// levels. Errors: bad_argument (options that contradict each other; those of validate(), of the original and the
/// start), empty (nothing drawn), cancelled.
Result<LadderResult> build_ladder(Model original, const LadderOptions& options = {}, Task task = {});

struct SimplifyModelOptions {
  std::size_t target_triangles = 0;  ///< drawn triangles; 0 = no count target
  double max_error = 0;              ///< measured maximum, model units; 0 = no error target
  SimplifyConstraints constraints;
  Effort effort = Effort::fast;
  measure::DistanceOptions distance;
  bool force = false;  ///< as LadderOptions::force, for counts that can't be reached
};

struct SimplifyModelResult {
  Level level;
  simplify::StopReason stop = simplify::StopReason::no_legal_collapse;
  simplify::LockCounts locked;
  std::string shortfall;  ///< empty = the target was reached
  double simplify_seconds = 0, measure_seconds = 0;
};

/// One level instead of a ladder. Errors: bad_argument (no target or both; those of validate()), empty, cancelled.
Result<SimplifyModelResult> simplify_model(const Model& original, const SimplifyModelOptions& options, Task task = {});

/// MSFT_screencoverage for each instance of the original and each level: the share of the screen that the instance's
/// bounding sphere covers at the next level's switch distance; the last 0.
std::vector<std::vector<double>> screen_coverages(const Ladder& ladder, const measure::View& view = {});

}  // namespace lodestone::chain
