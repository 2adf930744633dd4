// Welding by tolerance, first half: near vertices get one position, so that exact welding joins them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/math/vec.h"

namespace lodestone::spatial {

/// Each position, in order, takes the place of the nearest earlier one within `tolerance` that kept its own (the first
/// of equally near ones); so nothing moves farther than the tolerance, and chains of near points don't creep. Those
/// with `fixed` set (one entry a position; empty = none) come first and all keep their own. Returns how many moved.
/// Expected O(n), memory 24 bytes a position. Errors: bad_argument (tolerance not above 0 or not finite, positions that
/// are not finite, `fixed` of another size), cancelled.
Result<std::size_t> snap_positions(std::vector<Vec3f>& positions, double tolerance,
                                   const std::vector<std::uint8_t>& fixed = {}, Task task = {});

}  // namespace lodestone::spatial
