// What brings back the volume of an original.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lodestone/math/vec.h"
#include "lodestone/spatial/surface.h"

namespace lodestone::simplify::detail {

/// Moves along the normals, as far for each vertex that may move, after which a level has the volume of the original
/// (to first order). Empty unless both are closed. O(n log n).
std::vector<Vec3d> volume_moves(const spatial::Surface& original, const spatial::Surface& level,
                                std::span<const std::uint8_t> no_move);

}  // namespace lodestone::simplify::detail
