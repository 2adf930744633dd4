#include "lodestone/chain/scans/scan_surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lodestone/base/memory.h"
#include "lodestone/base/parallel.h"
#include "lodestone/base/units.h"
#include "lodestone/chain/scans/scan_colors_detail.h"
#include "lodestone/core/validate.h"
#include "lodestone/points/normals.h"
#include "lodestone/spatial/bvh.h"
#include "lodestone/spatial/closest_batch.h"
#include "lodestone/spatial/kd_tree.h"
#include "lodestone/voxel/isosurface.h"
#include "lodestone/voxel/resample.h"
#include "lodestone/voxel/scan.h"

namespace lodestone::chain {

namespace {

struct Distances {
  double sum = 0, most = 0;
};

// From points to the surface.
Result<Distances> distances_of(const PointCloud& cloud, const Model& model, const Task& task) {
  const Result<spatial::Surface> surface = spatial::flatten(model, Input::valid, task);
  LODESTONE_TRY(surface);
  const spatial::Bvh tree(*surface, task);
  constexpr std::size_t kChunk = 4096;
  return parallel_reduce(
      cloud.size(), kChunk, task, Distances{},
      [&](std::size_t begin, std::size_t end) {
        std::vector<Vec3d> points;
        for (std::size_t i = begin; i < end; ++i) points.push_back(cloud.position(i));
        std::vector<spatial::Nearest> nearest(points.size());
        spatial::ClosestBatch(tree).find(points, nearest);
        Distances d;
        for (const spatial::Nearest& n : nearest) {
          const double distance = std::sqrt(n.distance_sq);
          d.sum += distance;
          d.most = std::max(d.most, distance);
        }
        return d;
      },
      [](const Distances& a, const Distances& b) {
        return Distances{a.sum + b.sum, std::max(a.most, b.most)};
      });
}

// Voxels of half the distance from a point to its neighbours show all that the scan knows.
std::uint32_t usual_resolution(const PointCloud& cloud, const Task& task) {
  const double spacing = spatial::point_spacing(spatial::KdTree(cloud.positions, task), task).median;
  const Vec3d size = bounds_of(cloud).size();
  const double longest = std::max({size.x, size.y, size.z});
  const double wanted = spacing > 0 ? 2 * longest / spacing : 64;
  return static_cast<std::uint32_t>(std::clamp(wanted, 64.0, 512.0));
}

Result<void> add_normals(PointCloud& cloud, std::vector<std::string>& warnings, const Task& task) {
  const bool given = !cloud.normals.empty();
  // Normals that look inward everywhere, as some scanners write them, are turned.
  if (given && points::outward_share(cloud) < 0.2) {
    for (Vec3f& n : cloud.normals) n = n * -1.0F;
    warnings.emplace_back("the scan's normals look inward; they were turned");
  }
  if (given) return {};
  Result<points::Normals> made = points::estimate_normals(cloud, {}, task);
  LODESTONE_TRY(made);
  cloud.normals = std::move(made->normals);
  Result<points::Normals> oriented = points::orient_normals(cloud, {}, task);
  LODESTONE_TRY(oriented);
  cloud.normals = std::move(oriented->normals);
  warnings.emplace_back("the scan has no normals; they were estimated from its points");
  return {};
}

Result<Mesh> contour_splat(const PointCloud& cloud, const voxel::ScanOptions& options, voxel::ScanFigures& figures,
                           const Task& task) {
  voxel::ScanOptions splat = options;
  splat.splat_radius = 1;  // sheets of one voxel would fall apart
  const Result<voxel::ScanSolid> solid = voxel::scan_solid(cloud, splat, task);
  LODESTONE_TRY(solid);
  figures = solid->figures;
  const Result<ScalarVolume<std::uint8_t>> shares = voxel::downsample(solid->volume, solid->volume.grid.size, task);
  LODESTONE_TRY(shares);
  return voxel::isosurface(*shares, {127.5}, task);
}

Result<Mesh> contour_distance(const PointCloud& cloud, const voxel::ScanOptions& options, voxel::ScanFigures& figures,
                              const Task& task) {
  const Result<voxel::ScanDistance> distance = voxel::scan_distance(cloud, options, task);
  LODESTONE_TRY(distance);
  figures = distance->figures;
  Result<Mesh> mesh = voxel::isosurface(distance->volume, {0}, task);
  if (!mesh || !figures.open) return mesh;
  return voxel::trim_to_points(*mesh, cloud, figures.sheet_distance, task);
}

}  // namespace

Result<ScanSurface> surface_of_scan(PointCloud cloud, const ScanSurfaceOptions& options, Task task) {
  LODESTONE_TRY(validate(cloud, task));
  ScanSurface out;
  std::vector<std::string> warnings = cloud.warnings;
  voxel::ScanOptions scan;
  scan.resolution = options.resolution > 0 ? options.resolution : usual_resolution(cloud, task);
  scan.close_radius = options.close_radius;
  scan.most_bytes = available_memory_bytes() / 10 * 8;
  voxel::ScanFigures figures;
  if (!options.splat) {
    LODESTONE_TRY(add_normals(cloud, warnings, task.part(0.3, "estimating normals")));
  }
  Result<Mesh> mesh = options.splat ? contour_splat(cloud, scan, figures, task.part(0.5, "making a solid"))
                                    : contour_distance(cloud, scan, figures, task.part(0.5, "measuring distances"));
  LODESTONE_TRY(mesh);
  warnings.insert(warnings.end(), figures.warnings.begin(), figures.warnings.end());
  if (!cloud.colors.empty()) {
    const Task coloring = task.part(0.05, "coloring");
    add_scan_colors(cloud, spatial::KdTree(cloud.positions, coloring), figures.spacing, *mesh, warnings, coloring);
  }
  out.model = make_model(std::move(*mesh));
  out.model.meters_per_unit = cloud.meters_per_unit;
  out.model.file_vertices = cloud.file_points;
  out.spacing = figures.spacing;
  out.close_radius = figures.close_radius;
  out.open = figures.open;
  const Result<Distances> d = distances_of(cloud, out.model, task.part(0.15, "measuring"));
  LODESTONE_TRY(d);
  if (task.cancelled()) return cancelled_error("remeshing");
  out.mean_distance = d->sum / static_cast<double>(std::max<std::size_t>(1, cloud.size()));
  out.most_distance = d->most;
  warnings.push_back(
      fmt::format("the original is the surface of {} points, which lie {} from it on average, {} at most",
                  with_separators(cloud.size()), short_number(out.mean_distance), short_number(out.most_distance)));
  out.model.warnings = std::move(warnings);
  return out;
}

}  // namespace lodestone::chain
