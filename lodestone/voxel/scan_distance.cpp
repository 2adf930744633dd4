// A volume of signed distances from points with normals; its zero is the surface of the scan.
//
// Source: H. Hoppe et al., Surface Reconstruction from Unorganized Points, 1992 [hoppe-1992]: the distance to the plane
// of the nearest point. docs/papers/scans.md lists what differs. Planes are right near the points and say nothing
// elsewhere. The closed solid (see morphology.cpp) tells inside from outside everywhere, but bulges where a hole was.
// So planes decide in a band about the solid's surface, the solid beyond it, with a smooth change between.
// 1. Planes: the weighted mean of the distances to the planes of the nearest points; the weight falls to 0 just beyond
//    the last of them.
// 2. Distances: depth in the solid, and planes where points are near. It counts the voxels that planes call inside and
//    the solid all but outside: there no point makes the surface, so the scan is open.
// 3. fill_pockets(): what planes call outside but nothing leads to from outside is inside.
// 4. scan_distance(): plans grid and radius, grows the voxels that hold points, floods, takes distances from the
//    outside, and runs the steps above.
// Invariants: the solid's sign stands outside of the band, so holes up to the radius are closed. Each row of voxels is
// worked on by itself, its first query as if there had been none before: the same values for any thread count.
// Cost: one query of nearest points for each voxel of the band; memory as scan_distance_bytes() says.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include "lodestone/base/parallel.h"
#include "lodestone/spatial/kd_tree.h"
#include "lodestone/voxel/morphology.h"
#include "lodestone/voxel/scan.h"
#include "lodestone/voxel/scan_detail.h"

namespace lodestone::voxel {

namespace {

using spatial::KdTree;
using spatial::Neighbor;

// How far on either side of the closed solid's surface planes of points decide, voxels: the ball that closes a hole
// bulges by as much as its radius, planes don't. Less than the radius, so that there is an outside beyond the band.
double band_of(double radius) { return std::min(0.5 * radius + 1.5, radius - 0.5); }

// Distances to the planes of nearby points, in rows of voxels.
class Planes {
 public:
  Planes(const PointCloud& cloud, const KdTree& tree, std::uint32_t neighbors)
      : cloud_(cloud), tree_(tree), near_(neighbors) {}

  /// Above 0 inside, model units; `step` away from the voxel asked for before. Nothing where all normals are unknown.
  double at(Vec3d voxel, double step) {
    const Vec3d p = voxel - cloud_.offset;
    double below_sq = std::numeric_limits<double>::infinity();
    if (last_ >= 0) below_sq = (last_ + step) * (last_ + step) * 1.001;
    const std::size_t count = tree_.nearest(p, near_, below_sq);
    if (count == 0) return 0;
    last_ = count == near_.size() ? std::sqrt(near_[count - 1].distance_sq) : -1;
    // The weight falls to 0 a little beyond the last, so that values change smoothly where neighbours change.
    const double reach_sq = near_[count - 1].distance_sq * 1.1;
    double sum = 0, weights = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3d n = to_double(cloud_.normals[near_[i].point]);
      if (n == Vec3d{}) continue;
      const double rest = reach_sq > 0 ? 1 - near_[i].distance_sq / reach_sq : 1;
      const double weight = rest * rest;
      sum -= weight * dot(n, p - to_double(cloud_.positions[near_[i].point]));
      weights += weight;
    }
    return weights > 0 ? sum / weights : 0;
  }
  void start() { last_ = -1; }

 private:
  const PointCloud& cloud_;
  const KdTree& tree_;
  std::vector<Neighbor> near_;
  double last_ = -1;  // distance of the last neighbour of the query before; below 0: unknown
};

// Planes near the closed solid's surface, that solid's own distances farther away, and a smooth change between.
class Distances {
 public:
  Distances(const PointCloud& cloud, const KdTree& tree, const ScanOptions& options, double radius,
            const BitVolume& near_points, const ScalarVolume<std::uint16_t>& from_outside)
      : cloud_(cloud),
        tree_(tree),
        options_(options),
        radius_(radius),
        band_(band_of(radius)),
        side_(from_outside.grid.spacing.x),
        near_points_(near_points),
        from_outside_(from_outside) {}

  /// Fills `out`; returns in how many voxels planes call inside what is all but outside the band: there the surface
  /// comes from no point.
  std::uint64_t fill(ScalarVolume<float>& out, const Task& task) const {
    const auto& size = from_outside_.grid.size;
    const std::size_t rows = std::size_t{size[1]} * size[2];
    out.grid = from_outside_.grid;
    out.values.resize(from_outside_.values.size());
    return parallel_reduce(
        rows, 16, task, std::uint64_t{0},
        [&](std::size_t begin, std::size_t end) {
          Planes planes(cloud_, tree_, options_.neighbors);
          std::uint64_t open = 0;
          for (std::size_t row = begin; row < end; ++row) {
            open += fill_row(planes, static_cast<std::uint32_t>(row % size[1]),
                             static_cast<std::uint32_t>(row / size[1]), out.values.data() + row * size[0]);
          }
          task.advance(static_cast<double>(end - begin) / static_cast<double>(rows));
          return open;
        },
        std::plus<>());
  }

 private:
  // How deep a voxel is inside of the closed solid, voxels.
  double depth_of(std::uint16_t distance_sq) const {
    if (distance_sq == kBeyondReach) return band_ + 1;
    return std::min(std::sqrt(static_cast<double>(distance_sq)) - radius_, band_ + 1);
  }

  std::uint64_t fill_row(Planes& planes, std::uint32_t y, std::uint32_t z, float* values) const {
    const std::size_t first = from_outside_.index(0, y, z);
    planes.start();
    std::uint32_t last = 0;
    std::uint64_t open = 0;
    for (std::uint32_t x = 0; x < from_outside_.grid.size[0]; ++x) {
      const double depth = depth_of(from_outside_.values[first + x]);
      values[x] = static_cast<float>(depth * side_);
      if (std::abs(depth) >= band_ || !near_points_.at(x, y, z)) continue;
      const Vec3d center = from_outside_.grid.point({x + 0.5, y + 0.5, z + 0.5});
      const double distance = planes.at(center, (x - last) * side_);
      last = x;
      const double limit = (band_ + 1) * side_;
      const double share = std::clamp(2 * std::abs(depth) / band_ - 1, 0.0, 1.0);  // of the solid's depth
      values[x] = static_cast<float>(std::clamp(distance, -limit, limit) * (1 - share) + depth * side_ * share);
      if (distance > 0 && depth < 1 - band_) ++open;
    }
    return open;
  }

  const PointCloud& cloud_;
  const KdTree& tree_;
  const ScanOptions& options_;
  double radius_, band_, side_;
  const BitVolume& near_points_;
  const ScalarVolume<std::uint16_t>& from_outside_;
};

// What planes call outside but nothing leads to from outside is inside, as in the solid.
void fill_pockets(ScalarVolume<float>& volume, const Task& task) {
  BitVolume inside(volume.grid);
  const std::size_t width = volume.grid.size[0], rows = std::size_t{volume.grid.size[1]} * volume.grid.size[2];
  const auto each_voxel = [&](auto&& body) {
    parallel_for(rows, 64, task, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t row = begin; row < end; ++row) {
        for (std::size_t x = 0; x < width; ++x) {
          body(volume.values[row * width + x], row * inside.row_words + x / 64, std::uint64_t{1} << (x % 64));
        }
      }
    });
  };
  each_voxel([&](float value, std::size_t word, std::uint64_t bit) {
    if (value > 0) inside.words[word] |= bit;
  });
  if (task.cancelled()) return;
  const BitVolume outside = flooded_from_outside(inside);
  const float shallow = static_cast<float>(volume.grid.spacing.x / 4);
  each_voxel([&](float& value, std::size_t word, std::uint64_t bit) {
    if (!(value > 0) && (outside.words[word] & bit) == 0) value = std::max(-value, shallow);
  });
}

}  // namespace

std::uint64_t scan_distance_bytes(const VoxelGrid& grid, std::uint64_t points) {
  return grid.count() * 67 / 10 + 36 * points;
}

Result<ScanDistance> scan_distance(const PointCloud& cloud, const ScanOptions& options, const Task& task) {
  LODESTONE_TRY(detail::check_scan(cloud, options, task));
  if (cloud.normals.size() != cloud.size()) {
    return fail(ErrorCode::bad_argument, "the points have no normals", "scan", "estimate them");
  }
  const KdTree tree(cloud.positions, task.part(0.1));
  Result<detail::ScanPlan> plan = detail::plan_scan(cloud, tree, options, 0, scan_distance_bytes, task.part(0.1));
  LODESTONE_TRY(plan);
  const double radius = plan->radius;
  const auto reach = std::min(kMostReach, static_cast<std::uint32_t>(std::ceil(radius + band_of(radius))));
  ScanDistance out;
  out.figures = std::move(plan->figures);
  BitVolume near_points, outside;
  {
    const BitVolume points = detail::occupied(cloud, plan->grid);
    out.figures.surface_voxels = points.set_count();
    const auto from_points = distances_sq(points, reach, task.part(0.1));
    near_points = within(from_points, reach, task);
    outside = flooded_from_outside(within(from_points, radius, task));
  }
  if (task.cancelled()) return cancelled_error("scan");
  const auto from_outside = distances_sq(outside, reach, task.part(0.1));
  out.figures.open_voxels =
      Distances(cloud, tree, options, radius, near_points, from_outside).fill(out.volume, task.part(0.6));
  fill_pockets(out.volume, task);
  if (task.cancelled()) return cancelled_error("scan");
  // The far side of a shell lies at three quarters of the band, where planes and solid disagree most.
  out.figures.sheet_distance = (0.68 * band_of(radius) - 0.1) * out.volume.grid.spacing.x;
  out.figures.open = out.figures.open_voxels * 50 > out.figures.surface_voxels;
  if (out.figures.open) {
    out.figures.warnings.push_back(
        "what should be inside is joined to the outside: a hole is larger than the radius that is closed, or the "
        "points are one side of something");
  }
  return out;
}

}  // namespace lodestone::voxel
