// Colours carried on beyond the texels that have one.
#pragma once

#include <cstdint>
#include <vector>

#include "lodestone/base/task.h"
#include "lodestone/core/pixels.h"

namespace lodestone::bake::detail {

/// Gives texels that are not `set` (one a texel, non-zero = set) the mean of the set ones among their eight neighbours,
/// `rounds` times over, and what is left then `rest`. Same result for any thread count. O(texels x rounds).
void dilate(Pixels& pixels, std::vector<std::uint8_t> set, std::uint32_t rounds, std::array<std::uint8_t, 4> rest,
            const Task& task);

/// Mean of the set texels, byte by byte; 128 where none is.
std::array<std::uint8_t, 4> mean_of(const Pixels& pixels, const std::vector<std::uint8_t>& set);

}  // namespace lodestone::bake::detail
