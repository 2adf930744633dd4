// More triangles where a level is worst.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "lodestone/base/task.h"
#include "lodestone/core/mesh.h"
#include "lodestone/simplify/fit/tracked_level.h"

namespace lodestone::simplify {

struct SplitOptions {
  double share = 0;                      ///< of the maximum: triangles whose worst distance is above it are split
  std::size_t most = 0;                  ///< triangles that may be added
  bool keep_borders = false;             ///< open borders are neither split nor pulled
  std::vector<std::uint8_t> no_move{};   ///< one a vertex, non-zero = is not pulled; empty = none
  std::vector<std::uint8_t> no_split{};  ///< the same; non-zero = triangles around it are not split
};

struct SplitResult {
  Mesh mesh;                          ///< the level's vertices keep their numbers, new ones follow
  std::vector<std::uint32_t> pulled;  ///< vertices that have been pulled in
};

/// Adds a vertex where a triangle is worst and puts it on the original there, worst triangles first, no triangle twice:
/// within the triangle, or on its side where the place is near one. Where the place is a vertex (one that sticks out of
/// a bulge, say), that vertex is pulled half way to the original. Attributes are those of the level at the place. No
/// face may turn by more than some 70 degrees, and no vertex is pulled that lies on a seam or between materials.
/// O(n log n).
SplitResult split_worst(const TrackedLevel& level, const SplitOptions& options, const Task& task);

}  // namespace lodestone::simplify
