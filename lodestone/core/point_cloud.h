// PointCloud: what a scanner gives. Flat arrays, one entry a point in each that is there.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "lodestone/math/box.h"
#include "lodestone/math/vec.h"

namespace lodestone {

struct PointCloud {
  std::vector<Vec3f> positions;  ///< model units, relative to `offset`, finite
  Vec3d offset;                  ///< added to every position; zero unless coordinates are far from the origin
  /// Unit vectors that look outward; (0, 0, 0) where a point's is not known. Empty: there are none.
  std::vector<Vec3f> normals;
  std::vector<std::array<std::uint8_t, 4>> colors;  ///< sRGB, and alpha (255 where not told); or empty
  double meters_per_unit = 0;                       ///< 0 = the file doesn't say
  std::uint64_t file_points = 0;                    ///< as stored in the file, those left out included
  /// What a reader found and put right or left out, in plain words, for the user.
  std::vector<std::string> warnings;

  std::size_t size() const { return positions.size(); }
  /// Position with the offset, in double.
  Vec3d position(std::size_t point) const { return to_double(positions[point]) + offset; }
};

/// Box of all points, with the offset. O(n).
inline Box3d bounds_of(const PointCloud& cloud) {
  Box3f box;
  for (const Vec3f& p : cloud.positions) box.add(p);
  if (box.empty()) return {};
  return {to_double(box.min) + cloud.offset, to_double(box.max) + cloud.offset};
}

}  // namespace lodestone
