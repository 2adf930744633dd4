// More triangles where a level is worst.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lodestone/base/task.h"
#include "lodestone/core/mesh.h"
#include "lodestone/simplify/fit/tracked_level.h"

namespace lodestone::simplify {

struct SplitResult {
  Mesh mesh;
  std::vector<Vec3f> pulled;  ///< where vertices are now that have been pulled in
};

/// Adds a vertex where a triangle is worst and puts it on the original there, worst triangles first, those whose worst
/// distance is above `share` of the maximum, no triangle twice, until `most` triangles have been added: within the
/// triangle, or on its side where the place is near one. Where it is a vertex, as of those that stick out of bulges,
/// that goes half way to the original. Attributes are those of the level at the place. O(n log n).
/// Open borders are split and pulled, too, unless they are to be kept. No face may turn by more than some 70 degrees,
/// and no vertex is pulled that is `no_move` (one a vertex, non-zero = does not move; empty = none) or lies on a seam or between
/// materials. Triangles that have a vertex that is `no_split` (as `no_move`) are not split.
SplitResult split_worst(const TrackedLevel& level, double share, std::size_t most, bool keep_borders,
                        std::span<const std::uint8_t> no_move, std::span<const std::uint8_t> no_split,
                        const Task& task);

}  // namespace lodestone::simplify
