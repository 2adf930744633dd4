// Surface voxelization: which voxels a surface touches.
#pragma once

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/volume.h"
#include "lodestone/spatial/surface.h"

namespace lodestone::voxel {

enum class Thickness {
  conservative,  ///< every voxel whose box a triangle meets; no path over sides, edges or corners leads through
  separating_6,  ///< fewer: no path over sides leads through
};

/// Voxels of triangles, closed or not (M. Schwarz and H.-P. Seidel, Fast parallel surface and solid voxelization on
/// GPUs, SIGGRAPH Asia 2010: the triangle's plane, then its three projections). O(triangles + voxels of their boxes),
/// memory an eighth of a byte a voxel and 4 bytes a triangle and slab. Same bits for any thread count. Errors:
/// bad_argument (a grid without voxels, or with sides above 65,535; those of validate()), cancelled.
Result<BitVolume> surface_voxels(const spatial::Surface& surface, const VoxelGrid& grid,
                                 Thickness thickness = Thickness::conservative, Task task = {});

/// A solid from a surface with holes: its voxels grown by a ball of `radius` voxels, what can't be reached from outside
/// then is inside, and the growth is taken back. Holes up to twice the radius are closed, hollows are filled. The grid
/// needs a margin of radius + 2 empty voxels. O(voxels · radius) at worst, memory 2.4 bytes a voxel. Errors: as above,
/// bad_argument (a radius above 170).
Result<BitVolume> shrinkwrap(const spatial::Surface& surface, const VoxelGrid& grid, double radius, Task task = {});

}  // namespace lodestone::voxel
