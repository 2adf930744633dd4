// Surfaces of volumes by Marching Cubes.
#pragma once

#include <cstdint>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/mesh.h"
#include "lodestone/core/volume.h"

namespace lodestone::voxel {

struct IsosurfaceOptions {
  double iso = 0.5;  ///< what is above is inside
  /// The surface has the topology of the trilinear interpolant: faces whose inside corners lie opposite join them where
  /// the interpolant does, and two rings that a tube joins get it (Marching Cubes 33). For smooth values, as scanners
  /// give them; else such corners are always parted. Adds vertices within cubes. In cubes with three rings or more each
  /// is taken for a piece of its own.
  bool trilinear = false;
};

/// The surface between voxels above `iso` and those that are not, cut by cubes whose corners are the voxels' centres
/// (Lorensen and Cline 1987, faces decided alike from both sides). The volume counts as surrounded by voxels outside,
/// half a voxel behind which the surface closes: it is closed and manifold at its edges, whatever the values. Vertices
/// lie where the values, linear along an edge, reach `iso`, and are shared. Values that are not finite are outside.
/// Model units, Mesh::offset is the middle of the grid. No attributes. Same bytes for any thread count.
/// O(voxels + triangles), memory a bit a voxel and 12 bytes a row on top of the mesh. Errors: bad_argument (an iso that
/// is not finite; another number of values than voxels; those of validate()), empty (no voxel inside), unsupported
/// (more vertices than a mesh can name), cancelled.
Result<Mesh> isosurface(const VolumeView<std::uint8_t>& volume, const IsosurfaceOptions& options = {}, Task task = {});
Result<Mesh> isosurface(const VolumeView<std::int16_t>& volume, const IsosurfaceOptions& options = {}, Task task = {});
Result<Mesh> isosurface(const VolumeView<std::uint16_t>& volume, const IsosurfaceOptions& options = {}, Task task = {});
Result<Mesh> isosurface(const VolumeView<float>& volume, const IsosurfaceOptions& options = {}, Task task = {});

}  // namespace lodestone::voxel
