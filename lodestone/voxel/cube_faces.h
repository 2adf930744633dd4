// Voxel models as they are: cubes.
#pragma once

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/mesh.h"
#include "lodestone/core/volume.h"

namespace lodestone::voxel {

/// Two triangles for each side of a set voxel whose neighbour there is not set ([voxel-lod], section 2.3.5, figures 12
/// to 15), faces outward, corners shared; where set voxels touch along an edge alone, that edge has four faces. Model
/// units. O(voxels / 64 + faces), memory 8 bytes a column on top of the mesh. Errors: bad_argument (those of
/// validate()), empty (no voxel set), unsupported (more corners than a mesh can name), cancelled.
Result<Mesh> cube_faces(const BitVolume& volume, Task task = {});

}  // namespace lodestone::voxel
