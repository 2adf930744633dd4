#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lodestone/base/units.h"
#include "lodestone/core/validate.h"
#include "lodestone/voxel/morphology.h"
#include "lodestone/voxel/scan_detail.h"
#include "lodestone/voxel/voxelize.h"

namespace lodestone::voxel::detail {

namespace {

constexpr double kLeastRadius = 2, kMostRadius = 170;  // voxels
constexpr double kMostShare = 1.0 / 3;                 // of the longest side

// A voxel stands for all of it: so much nearer than told a point may be to a voxel's centre, and the other way round.
constexpr double kHalfDiagonal = 0.87;

// How many voxels are left empty on each side so that the closing has room, where `inner` of them are to cover the
// points' longest side.
std::uint32_t margin_of(double radius_share, std::uint32_t inner, std::uint32_t extra) {
  const double radius = std::max(kLeastRadius, radius_share * inner) + kHalfDiagonal;
  return static_cast<std::uint32_t>(std::ceil(radius)) + 2 + extra;
}

// The largest grid, at most `resolution` along its longest side.
std::uint32_t inner_of(double radius_share, std::uint32_t resolution, std::uint32_t extra) {
  std::uint32_t inner = resolution;
  while (inner > 0 && inner + 2 * margin_of(radius_share, inner, extra) > resolution) --inner;
  return inner;
}

VoxelGrid grid_of(const Box3d& bounds, double longest, std::uint32_t inner, std::uint32_t margin) {
  VoxelGrid grid;
  const double side = longest / inner;
  grid.spacing = {side, side, side};
  for (std::size_t k = 0; k < 3; ++k) {
    const double cells = std::clamp(std::ceil(bounds.size()[k] / side - 1e-9), 1.0, static_cast<double>(inner));
    grid.size[k] = static_cast<std::uint32_t>(cells) + 2 * margin;
    grid.origin[k] = bounds.center()[k] - side * grid.size[k] / 2;
  }
  return grid;
}

Error too_large(const VoxelGrid& grid, std::uint64_t needed, std::uint64_t most, std::uint32_t resolution) {
  // Bytes grow with the third power.
  const double share = static_cast<double>(most) / static_cast<double>(needed);
  double fits = resolution;
  while (fits > 1 && fits * fits * fits > share * 0.9 * resolution * resolution * resolution) fits -= 1;
  return {ErrorCode::out_of_memory,
          fmt::format("a grid of {} x {} x {} voxels needs {}, the limit is {}", grid.size[0], grid.size[1],
                      grid.size[2], human_bytes(needed), human_bytes(most)),
          "scan", fmt::format("use a resolution of {} or raise the limit", static_cast<std::uint32_t>(fits))};
}

}  // namespace

Result<void> check_scan(const PointCloud& cloud, const ScanOptions& options, const Task& task) {
  if (cloud.positions.empty()) return fail(ErrorCode::empty, "there are no points", "scan");
  if (options.resolution < 16 || options.resolution > 65535) {
    return fail(ErrorCode::bad_argument, fmt::format("a resolution of {} can't be", options.resolution), "scan",
                "use 16 to 65,535");
  }
  if (!(options.close_radius >= 0) || !std::isfinite(options.close_radius)) {
    return fail(ErrorCode::bad_argument, "the radius of holes is not a length", "scan", "use 0 or more");
  }
  if (!(options.splat_radius >= 0 && options.splat_radius <= 8)) {
    return fail(ErrorCode::bad_argument, fmt::format("points can't be {} voxels large", options.splat_radius), "scan",
                "use 0 to 8");
  }
  if (options.neighbors < 1 || options.neighbors > 64) {
    return fail(ErrorCode::bad_argument, fmt::format("{} neighbours can't be used", options.neighbors), "scan",
                "use 1 to 64");
  }
  LODESTONE_TRY(validate(cloud, task));
  const Box3d bounds = bounds_of(cloud);
  const Vec3d size = bounds.size();
  const double longest = std::max({size.x, size.y, size.z});
  if (!(longest > 0) || !is_finite(bounds.min) || !is_finite(bounds.max)) {
    return fail(ErrorCode::bad_argument, "all points lie in one place", "scan", "is it the right file?");
  }
  return {};
}

Result<ScanPlan> plan_scan(const PointCloud& cloud, const spatial::KdTree& tree, const ScanOptions& options,
                           std::uint32_t extra, std::uint64_t (*bytes)(const VoxelGrid&, std::uint64_t),
                           const Task& task) {
  ScanPlan plan;
  const Box3d bounds = bounds_of(cloud);
  const Vec3d size = bounds.size();
  const double longest = std::max({size.x, size.y, size.z});
  const spatial::Spacing spacing = spatial::point_spacing(tree, task);
  plan.figures.spacing = spacing.median;
  if (task.cancelled()) return cancelled_error("scan");
  double radius = options.close_radius;
  if (radius == 0) radius = std::min(2 * spacing.wide, longest * kMostShare);
  if (radius > longest * kMostShare) {
    return fail(
        ErrorCode::bad_argument,
        fmt::format("holes of radius {} in a scan of {} can't be closed", short_number(radius), short_number(longest)),
        "scan", fmt::format("use at most {}", short_number(longest * kMostShare)));
  }
  const std::uint32_t inner = inner_of(radius / longest, options.resolution, extra);
  if (inner < 4) {
    return fail(ErrorCode::bad_argument,
                fmt::format("a resolution of {} leaves no room for points", options.resolution), "scan",
                "use a higher one or a smaller radius of holes");
  }
  const double side = longest / inner;
  plan.radius = std::max(kLeastRadius, radius / side);
  if (plan.radius > kMostRadius) {
    if (options.close_radius > 0) {
      return fail(ErrorCode::bad_argument,
                  fmt::format("the radius of holes is {:.0f} voxels, the limit is {:.0f}", plan.radius, kMostRadius),
                  "scan", "use a lower resolution or a smaller radius");
    }
    plan.radius = kMostRadius;
  }
  plan.figures.close_radius = plan.radius * side;
  plan.radius += kHalfDiagonal;
  plan.grid = grid_of(bounds, longest, inner, margin_of(radius / longest, inner, extra));
  if (const std::uint64_t needed = bytes(plan.grid, cloud.size()); needed > options.most_bytes) {
    return fail(too_large(plan.grid, needed, options.most_bytes, options.resolution));
  }
  if (plan.figures.spacing > 3 * side) {
    plan.figures.warnings.push_back(
        fmt::format("voxels of {} are much smaller than the distance of {} between points: details can't be seen",
                    short_number(side), short_number(plan.figures.spacing)));
  }
  return plan;
}

BitVolume occupied(const PointCloud& cloud, const VoxelGrid& grid) {
  BitVolume out(grid);
  const Vec3d origin = grid.origin - cloud.offset;
  for (const Vec3f& p : cloud.positions) {
    std::uint32_t at[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const double cell = std::floor((static_cast<double>(p[k]) - origin[k]) / grid.spacing[k]);
      at[k] = static_cast<std::uint32_t>(std::clamp(cell, 0.0, static_cast<double>(grid.size[k] - 1)));
    }
    out.set(at[0], at[1], at[2]);
  }
  return out;
}

}  // namespace lodestone::voxel::detail
