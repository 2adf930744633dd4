// Generalised winding numbers: how far a point is inside of a surface that need not be closed.
#pragma once

#include <cstdint>
#include <vector>

#include "lodestone/base/task.h"
#include "lodestone/spatial/surface.h"

namespace lodestone::voxel {

/// The solid angle of all triangles as seen from a point, over 4 pi: 1 inside and 0 outside of a closed surface with
/// its faces outward, between where there are holes (A. Jacobson, L. Kavan and O. Sorkine-Hornung, Robust
/// Inside-Outside Segmentation using Generalized Winding Numbers, SIGGRAPH 2013). Groups of triangles that are farther
/// away than twice their radius count as one (G. Barill, N. Dickson, R. Schmidt, D. Levin and A. Jacobson, Fast Winding
/// Numbers for Soups and Clouds, SIGGRAPH 2018, first order), which is off by some hundredths. Build O(n), a query
/// O(log n), memory 9 bytes a triangle. The surface must outlive it. No libm: the same bits on every machine.
class WindingNumber {
 public:
  explicit WindingNumber(const spatial::Surface& surface, const Task& task = {});

  double at(Vec3d point) const;

 private:
  // Of consecutive triangles, which lie near each other, as the surface runs along a Hilbert curve.
  struct Group {
    Vec3d center;       // by area
    Vec3d area_normal;  // sum of the triangles' normals times their areas
    double radius_sq = 0;
    double area = 0;
  };
  double exact(std::size_t begin, std::size_t end, Vec3d point) const;

  const spatial::Surface& surface_;
  std::vector<Group> groups_;             // level 0 (of kFan triangles) first, the root last
  std::vector<std::size_t> level_first_;  // first group of each level, and the end
};

}  // namespace lodestone::voxel
