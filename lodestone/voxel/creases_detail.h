// Edges of a surface at which it bends, and where they run through a grid's cubes.
#pragma once

#include <cstdint>
#include <vector>

#include "lodestone/core/volume.h"
#include "lodestone/spatial/surface.h"

namespace lodestone::voxel::detail {

/// A point on a crease, or where creases meet or turn, that stands for all of them in one cube.
struct CreasePoint {
  std::uint64_t cube = 0;  ///< (z * height + y) * width + x of the padded rows
  Vec3d point;
  bool corner = false;
};

/// For each cube from voxel centre to voxel centre (with a layer of voxels around the grid) that a crease runs through,
/// the middle of its run, or the corner that lies in it; by cube. Creases are edges between two triangles whose normals
/// differ by more than the angle of `cosine`. O(n log n).
std::vector<CreasePoint> crease_points(const spatial::Surface& surface, const VoxelGrid& grid, double cosine);

}  // namespace lodestone::voxel::detail
