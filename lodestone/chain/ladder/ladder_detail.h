// What ladders of every method share.
#pragma once

#include <cstddef>
#include <vector>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/chain/ladder/build_ladder.h"
#include "lodestone/core/level.h"

namespace lodestone::chain::detail {

/// Errors: bad_argument (options that contradict each other, lists that don't fall or rise; those of validate(), of the
/// original and what levels start from), empty (nothing drawn), cancelled.
Result<void> check_ladder(const Model& original, const LadderOptions& options, const Task& task);

/// Wanted drawn triangles of each coarser level.
std::vector<std::size_t> count_targets(const LadderOptions& options, std::size_t drawn);

/// Level 0: the original itself.
Level original_level(const Model& original, double diagonal);

/// Fills result.images. Errors: those of drawing.
Result<void> compare_pictures(LadderResult& result, const measure::ImageOptions& options, const Task& task);

}  // namespace lodestone::chain::detail
