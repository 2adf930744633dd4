// Shapes of voxels grown, shrunk and flooded from outside.
#pragma once

#include <cstdint>

#include "lodestone/base/task.h"
#include "lodestone/core/volume.h"

namespace lodestone::voxel {

/// The farthest that distances between voxels are told, in voxels.
inline constexpr std::uint32_t kMostReach = 180;
/// Stands for everything farther than that.
inline constexpr std::uint16_t kBeyondReach = 0x8000;

/// For each voxel the squared distance from its centre to that of the nearest set one, in voxels whatever their
/// spacing; kBeyondReach where it is above `reach` (at most kMostReach). What lies around the grid counts as not set.
/// Exact. O(voxels · reach) at worst, little where nothing is near; memory 2 bytes a voxel. After a cancelled task the
/// values mean nothing. The same for any thread count.
ScalarVolume<std::uint16_t> distances_sq(const BitVolume& volume, std::uint32_t reach, const Task& task = {});

/// The voxels whose squared distance is at most radius².
BitVolume within(const ScalarVolume<std::uint16_t>& distances_sq, double radius, const Task& task = {});

/// The voxels that are not set and that a path over sides of such voxels joins to the outside of the grid. O(voxels /
/// 64) and somewhat more in mazes.
BitVolume flooded_from_outside(const BitVolume& walls);

/// Everything set becomes unset and the other way round.
BitVolume complement(BitVolume volume);

}  // namespace lodestone::voxel
