// Filters of volumes: blur and median.
#pragma once

#include <array>
#include <cstdint>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/volume.h"

namespace lodestone::voxel {

/// The same values as floats. O(voxels). Errors: bad_argument (those of validate()), cancelled.
Result<ScalarVolume<float>> as_float(const VolumeView<std::uint8_t>& volume, Task task = {});
Result<ScalarVolume<float>> as_float(const VolumeView<std::int16_t>& volume, Task task = {});
Result<ScalarVolume<float>> as_float(const VolumeView<std::uint16_t>& volume, Task task = {});
Result<ScalarVolume<float>> as_float(const VolumeView<float>& volume, Task task = {});

/// How far a blur of these standard deviations, in voxels, looks along each axis: three of them, rounded up.
std::array<std::uint32_t, 3> gaussian_reach(Vec3d sigma);

/// The volume as floats with `more` voxels of 0 on every side. O(voxels).
ScalarVolume<float> padded(const VolumeView<std::uint8_t>& volume, const std::array<std::uint32_t, 3>& more);

/// Blurs by a Gaussian of these standard deviations in voxels, cut off after three of them; beyond the border the
/// border's values go on. 0 = no blur along that axis. Divide millimetres by the spacing to get voxels. Same values for
/// any thread count. O(voxels · sigma). Errors: bad_argument (negative, above 1000, not finite; those of validate()),
/// cancelled.
Result<ScalarVolume<float>> gaussian(ScalarVolume<float> volume, Vec3d sigma, Task task = {});

/// The middle one of the (2 radius + 1)³ values around each voxel, the border's values going on beyond it; values that
/// are no numbers count as the least. O(voxels · radius³). Errors: bad_argument (a radius of 0 or above 7; those of
/// validate()), cancelled.
Result<ScalarVolume<float>> median(const VolumeView<std::uint8_t>& volume, std::uint32_t radius, Task task = {});
Result<ScalarVolume<float>> median(const VolumeView<std::int16_t>& volume, std::uint32_t radius, Task task = {});
Result<ScalarVolume<float>> median(const VolumeView<std::uint16_t>& volume, std::uint32_t radius, Task task = {});
Result<ScalarVolume<float>> median(const VolumeView<float>& volume, std::uint32_t radius, Task task = {});

}  // namespace lodestone::voxel
