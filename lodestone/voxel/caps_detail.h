// Triangles that close a surface, whatever it is.
#pragma once

#include <cstdint>
#include <vector>

#include "lodestone/base/task.h"
#include "lodestone/spatial/surface.h"

namespace lodestone::voxel::detail {

/// Triangles of the surface's own vertices such that each edge of surface and caps together is walked as often one way
/// as the other, vertices at one place taken for one. Holes, borders of sheets, and edges where faces turn over or more
/// than two meet: their edges form loops, each of which is halved again and again, so that a loop's small triangles lie
/// along it. None for a closed surface with its faces all outward or all inward. O(n log n).
std::vector<Triangle> caps_of(const spatial::Surface& surface, const Task& task);

}  // namespace lodestone::voxel::detail
