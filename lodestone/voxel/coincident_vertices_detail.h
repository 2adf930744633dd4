// Vertices that came to lie at one place.
#pragma once

#include <vector>

#include "lodestone/math/vec.h"

namespace lodestone::voxel::detail {

/// Puts all but the first of vertices at one place back to where they were: whoever welds by position would take them
/// for one, and the surface would not be manifold. O(n log n).
void separate_coincident_vertices(const std::vector<Vec3f>& before, std::vector<Vec3f>& moved);

}  // namespace lodestone::voxel::detail
