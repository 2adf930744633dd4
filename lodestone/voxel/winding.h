// Generalised winding numbers: how far a point is inside of a surface that need not be closed.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "lodestone/base/task.h"
#include "lodestone/spatial/surface.h"

namespace lodestone::voxel {

/// The solid angle of all triangles as seen from a point, over 4 pi: 1 inside and 0 outside of a closed surface with
/// its faces outward, between where there are holes (A. Jacobson, L. Kavan and O. Sorkine-Hornung, Robust
/// Inside-Outside Segmentation using Generalized Winding Numbers, SIGGRAPH 2013). Groups of triangles that are farther
/// away than twice their radius count as one (G. Barill, N. Dickson, R. Schmidt, D. Levin and A. Jacobson, Fast Winding
/// Numbers for Soups and Clouds, SIGGRAPH 2018, first order), which is off by some hundredths. Build O(n log n), a
/// query O(log n), memory 110 bytes a triangle. The positions must outlive it. No libm: the same bits on every machine.
class WindingNumber {
 public:
  WindingNumber(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles, const Task& task = {});
  explicit WindingNumber(const spatial::Surface& surface, const Task& task = {})
      : WindingNumber(surface.positions, surface.triangles, task) {}

  double at(Vec3d point) const;

 private:
  // Of consecutive triangles, which are of like size and lie near each other.
  struct Group {
    Vec3d center;       // by area
    Vec3d area_normal;  // sum of the triangles' normals times their areas
    double radius_sq = 0;
    double area = 0;
  };
  std::array<Vec3d, 3> corners(std::size_t triangle) const;
  Group group_of(std::size_t first, std::size_t last) const;

  const std::vector<Vec3d>& positions_;
  std::vector<Triangle> triangles_;       // by size, then along a Hilbert curve
  std::vector<Group> groups_;             // level 0 (single triangles) first, the root last
  std::vector<std::size_t> level_first_;  // first group of each level
};

}  // namespace lodestone::voxel
