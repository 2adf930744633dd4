// Booleans of solids, bit by bit.
#pragma once

#include "lodestone/base/result.h"
#include "lodestone/core/volume.h"

namespace lodestone::voxel {

enum class BooleanOperation { unite, intersect, subtract };

/// a becomes a or b, a and b, or a without b. O(words). Errors: bad_argument (grids that differ; those of
/// validate()).
Result<void> combine(BitVolume& a, const BitVolume& b, BooleanOperation operation);

}  // namespace lodestone::voxel
