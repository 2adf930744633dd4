// What ladders of every method share.
#pragma once

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/chain/build_ladder.h"
#include "lodestone/core/level.h"

namespace lodestone::chain::detail {

/// Level 0: the original itself.
Level original_level(const Model& original, double diagonal);

/// Fills result.images. Errors: those of drawing.
Result<void> compare_pictures(LadderResult& result, const measure::ImageOptions& options, const Task& task);

}  // namespace lodestone::chain::detail
