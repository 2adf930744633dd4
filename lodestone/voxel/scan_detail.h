// What both ways from a scan to a volume have in common.
#pragma once

#include <cstdint>
#include <vector>

#include "lodestone/base/result.h"
#include "lodestone/core/point_cloud.h"
#include "lodestone/core/volume.h"
#include "lodestone/spatial/kd_tree.h"
#include "lodestone/voxel/scan.h"

namespace lodestone::voxel::detail {

struct ScanPlan {
  VoxelGrid grid;     ///< cubes, with room around the points for the closing
  double radius = 0;  ///< of the closing, voxels
  ScanFigures figures;
};

/// Checks cloud and options, all but the normals.
Result<void> check_scan(const PointCloud& cloud, const ScanOptions& options, const Task& task);

/// Grid and radius. `extra` more voxels are left empty all around. `bytes` says what a grid needs.
Result<ScanPlan> plan_scan(const PointCloud& cloud, const spatial::KdTree& tree, const ScanOptions& options,
                           std::uint32_t extra, std::uint64_t (*bytes)(const VoxelGrid&, std::uint64_t),
                           const Task& task);

/// The voxels that hold a point.
BitVolume occupied(const PointCloud& cloud, const VoxelGrid& grid);

}  // namespace lodestone::voxel::detail
