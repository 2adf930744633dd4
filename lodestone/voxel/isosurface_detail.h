// A contoured volume with all that its making knew.
#pragma once

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/mesh.h"
#include "lodestone/core/volume.h"
#include "lodestone/voxel/cube_surface_detail.h"
#include "lodestone/voxel/inside_rows_detail.h"

namespace lodestone::voxel::detail {

struct Contour {
  InsideRows rows;
  CubeSurface surface;
  Mesh mesh;
};

/// As voxel::isosurface.
Result<Contour> contour(const VolumeView<std::uint8_t>& volume, double iso, const Task& task);

}  // namespace lodestone::voxel::detail
