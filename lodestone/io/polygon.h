// Cutting polygons into triangles, concave and bent ones too.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "lodestone/math/vec.h"

namespace lodestone::io {

/// Three corner numbers of the polygon that was cut.
using CornerTriple = std::array<std::uint32_t, 3>;

/// Cuts polygons by clipping ears in the plane of the Newell normal (Newell's method for the normal; ears: Meisters
/// 1975). A polygon of n corners always gives n - 2 triangles that use all its corners and sides and keep its winding.
/// Where it crosses itself or has no area, the triangles cover no well-defined region but still have these sides. Holds
/// scratch memory, so keep one for many polygons.
class PolygonCutter {
 public:
  /// The triples hold until the next call. Fewer than 3 corners: none. O(n * number of corners that are not convex),
  /// and at most some thousand steps a corner: what is left of worse ones is cut as a fan.
  std::span<const CornerTriple> cut(std::span<const Vec3d> corners);

 private:
  void fan(std::size_t corners);
  void quad(std::span<const Vec3d> corners);
  bool project(std::span<const Vec3d> corners);
  void clip_ears();
  bool is_ear(std::uint32_t corner);
  double area_at(std::uint32_t corner) const;
  void update(std::uint32_t corner);

  std::vector<CornerTriple> triples_;
  std::vector<Vec2d> flat_;
  std::vector<std::uint32_t> before_, after_;
  std::vector<std::uint32_t> blunt_;    // corners that are not convex, and so may lie in another's ear
  std::vector<std::uint8_t> is_blunt_;  // by corner; blunt_ may still hold corners that have become convex
  std::uint64_t budget_ = 0;
};

}  // namespace lodestone::io
