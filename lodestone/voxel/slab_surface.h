// Surfaces on grids that are too large to be held as values: a slab of the solid at a time.
#pragma once

#include <array>
#include <cstdint>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/mesh.h"
#include "lodestone/core/volume.h"
#include "lodestone/spatial/surface.h"
#include "lodestone/voxel/voxelize.h"

namespace lodestone::voxel {

struct SlabSurface {
  Mesh mesh;
  std::uint64_t voxels_inside = 0;    ///< of the solid
  std::uint64_t leaking_columns = 0;  ///< as in Voxelized
  double voxelize_seconds = 0, resample_seconds = 0, isosurface_seconds = 0;
};

/// The surface of a solid of `grid`'s voxels, `size` larger ones of which are inside where at least half of their
/// voxels are; vertices half way between voxels, to be moved onto the source by project(). The solid is made slab by
/// slab, so that memory is an eighth of a byte a large voxel, 64 MB, and some 26 bytes a triangle of the result: 2048³
/// take 1.1 GB and the mesh. Each side of the grid must be a whole multiple of the larger one. Closed and manifold as
/// isosurface(). Errors: those of voxelize(), bad_argument (sizes that don't fit, shrinkwrap, which needs all at once),
/// empty, unsupported, cancelled.
Result<SlabSurface> slab_surface(const spatial::Surface& surface, const VoxelGrid& grid,
                                 const std::array<std::uint32_t, 3>& size, const VoxelizeOptions& options = {},
                                 Task task = {});

}  // namespace lodestone::voxel
