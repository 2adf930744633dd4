// FillRule::winding.
#pragma once

#include "lodestone/base/task.h"
#include "lodestone/core/volume.h"
#include "lodestone/spatial/surface.h"

namespace lodestone::voxel::detail {

/// Sets the voxels whose centres have a winding number above a half, either way round.
void fill_winding(const spatial::Surface& surface, BitVolume& volume, const Task& task);

}  // namespace lodestone::voxel::detail
