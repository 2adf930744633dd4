#include <algorithm>
#include <cmath>

#include "lodestone/spatial/kd_tree.h"
#include "lodestone/voxel/morphology.h"
#include "lodestone/voxel/scan.h"
#include "lodestone/voxel/scan_detail.h"

namespace lodestone::voxel {

namespace {

std::uint32_t whole(double radius) { return static_cast<std::uint32_t>(std::ceil(radius)); }

}  // namespace

std::uint64_t scan_solid_bytes(const VoxelGrid& grid, std::uint64_t points) {
  return grid.count() * 5 / 2 + 36 * points;
}

Result<ScanSolid> scan_solid(const PointCloud& cloud, const ScanOptions& options, const Task& task) {
  LODESTONE_TRY(detail::check_scan(cloud, options, task));
  Result<detail::ScanPlan> plan = detail::plan_scan(cloud, spatial::KdTree(cloud.positions, task.part(0.1)), options,
                                                    whole(options.splat_radius), scan_solid_bytes, task.part(0.2));
  LODESTONE_TRY(plan);
  ScanSolid out;
  out.figures = std::move(plan->figures);
  BitVolume outside;
  {
    const BitVolume points = detail::occupied(cloud, plan->grid);
    out.figures.surface_voxels = points.set_count();
    const auto from_points = distances_sq(points, whole(plan->radius), task.part(0.3));
    outside = flooded_from_outside(within(from_points, plan->radius, task));
  }
  if (task.cancelled()) return cancelled_error("scan");
  constexpr double kDeep = 2;  // voxels
  const auto from_outside = distances_sq(outside, whole(plan->radius + kDeep), task.part(0.3));
  const double back = std::max(0.0, plan->radius - options.splat_radius);
  out.volume = complement(within(from_outside, back, task));
  // A sheet, whose folds the closing may have filled, has next to nothing that lies deep.
  const std::uint64_t deep = complement(within(from_outside, back + kDeep, task)).set_count();
  if (task.cancelled()) return cancelled_error("scan");
  out.figures.open = deep * 4 < out.volume.set_count();
  if (out.figures.open) {
    out.figures.warnings.push_back(
        "the points enclose next to nothing: a hole is larger than the radius that is closed, or they are one side of "
        "something");
  }
  return out;
}

}  // namespace lodestone::voxel
