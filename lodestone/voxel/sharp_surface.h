// Surfaces of solids that keep the edges and corners of their source.
#pragma once

#include <cstddef>
#include <cstdint>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/mesh.h"
#include "lodestone/core/volume.h"
#include "lodestone/spatial/bvh.h"

namespace lodestone::voxel {

struct SharpOptions {
  double iso = 127.5;
  double crease_cosine = 0.86603;  ///< edges of the source bend by more than the angle of this: 30 degrees
};

struct SharpSurface {
  Mesh mesh;
  std::size_t features = 0;  ///< vertices on edges and corners of the source
};

/// The dual of voxel::isosurface: a vertex for each ring in which the surface leaves a cube, and two triangles for each
/// crossed edge, over the four rings around it (Nielson, Dual Marching Cubes, 2004). A cube through which a crease of
/// the source runs has its vertex on it, within the cube, at a corner of the source if there is one; all other vertices
/// are the source's closest points to the middles of their rings. So creases are followed from cube to cube. Closed and
/// manifold at every edge: where two rings share two sides, these get a vertex each. O(voxels + triangles log source).
/// Same bytes for any thread count. Errors: as voxel::isosurface.
Result<SharpSurface> sharp_surface(const VolumeView<std::uint8_t>& volume, const spatial::Bvh& source,
                                   const SharpOptions& options = {}, Task task = {});

}  // namespace lodestone::voxel
