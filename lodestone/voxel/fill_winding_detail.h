// FillRule::winding.
#pragma once

#include "lodestone/base/task.h"
#include "lodestone/core/volume.h"
#include "lodestone/spatial/surface.h"

namespace lodestone::voxel::detail {

/// Sets the voxels whose centres have a winding number above a half, either way round. That of the surface is that of
/// surface and caps, a whole number that changes at crossings only, less that of the caps: so only the caps, which are
/// few or none, need solid angles. O(n log n + crossings + columns * log(caps)) on most models.
void fill_winding(const spatial::Surface& surface, BitVolume& volume, const Task& task);

}  // namespace lodestone::voxel::detail
