// Which triangles of a surface meet at each of their sides.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "lodestone/spatial/surface.h"

namespace lodestone::spatial {

/// For each triangle the one across its side k (from corner k to corner k + 1), which walks that side the other way.
/// kNone where there is none, more than one, or one that walks it the same way (the surface is not consistently
/// oriented there), and at all sides of a triangle that names a vertex twice. O(n), 12 bytes a triangle.
std::vector<std::array<std::uint32_t, 3>> triangle_neighbors(const Surface& surface);

}  // namespace lodestone::spatial
