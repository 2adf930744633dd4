// Surfaces of scans: points, with or without normals, become a model.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/model.h"
#include "lodestone/core/point_cloud.h"

namespace lodestone::chain {

struct ScanSurfaceOptions {
  std::uint32_t resolution = 0;  ///< voxels along the longest side; 0 = half the points' spacing each, 64 to 512
  double close_radius = 0;       ///< holes up to twice this are closed, model units; 0 = by the scan's spacing
  /// The solid of voxels that hold points, closed from outside, in place of signed distances: no normals are needed,
  /// but the surface lies half a voxel outside.
  bool splat = false;
};

struct ScanSurface {
  Model model;
  double spacing = 0;        ///< of the points, the median, model units
  double close_radius = 0;   ///< that was used
  double mean_distance = 0;  ///< from the points to the surface, model units
  double most_distance = 0;
  bool open = false;  ///< holes larger than the radius: the surface has borders
};

/// Signed distances to planes of the nearest points (or `splat`), contoured. Normals that the cloud has not are
/// estimated and oriented. Open scans are cut back to where points are. Colours of points come out as COLOR_0 of the
/// vertices: of the nearest points averaged, as light (points hold sRGB). O(points log points + voxels). Errors: those
/// of voxel::scan_distance and validate().
Result<ScanSurface> surface_of_scan(PointCloud cloud, const ScanSurfaceOptions& options = {}, Task task = {});

}  // namespace lodestone::chain
