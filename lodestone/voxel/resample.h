// Volumes at other resolutions.
#pragma once

#include <array>
#include <cstdint>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/volume.h"

namespace lodestone::voxel {

/// The extended voxel function of [voxel-lod] (VoxExt, equations 2-11 to 2-14): trilinear between the eight voxels
/// around a point, 0 outside of the volume; in [0, 1]. `at` is in voxels, whole numbers are voxels' centres as in the
/// paper: VoxelGrid's coordinates less one half.
double voxel_value(const BitVolume& volume, Vec3d at);

/// Which share of each larger voxel is set, 0 to 255 (to the nearest), from exact counts. Larger voxel i takes voxels
/// floor(i r) to floor((i + 1) r) - 1 with r = old size / new size along each axis, so any size up to the old one will
/// do; where r is not whole, places are off by up to half a small voxel. O(voxels / 64 + large voxels · r²). Errors:
/// bad_argument (a size of 0 or above the old one; those of validate()), cancelled.
Result<ScalarVolume<std::uint8_t>> downsample(const BitVolume& volume, const std::array<std::uint32_t, 3>& size,
                                              Task task = {});

/// As downsample(), but a larger voxel in which any is set counts as inside at 127.5, so that what is thinner than it
/// stays: shares below a half are raised to just above it. Errors: as above.
Result<ScalarVolume<std::uint8_t>> downsample_thin(const BitVolume& volume, const std::array<std::uint32_t, 3>& size,
                                                   Task task = {});

}  // namespace lodestone::voxel
