// Cutting polygons into triangles, concave and bent ones too.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "lodestone/math/vec.h"

namespace lodestone::io {

/// Three corner numbers of the polygon that was cut.
using CornerTriple = std::array<std::uint32_t, 3>;

/// Cuts polygons in the plane of the Newell normal: ears are clipped (Meisters 1975), those with the shortest cut
/// first, then diagonals are turned until the triangles are constrained Delaunay (Lawson 1977), which makes the
/// smallest angles as large as they can be. A polygon of n corners always gives n - 2 triangles that use all its
/// corners and sides and keep its winding; four corners are cut along 0-2 unless only 1-3 is inside. Where it crosses
/// itself or has no area, the triangles cover no well-defined region but still have these sides. Holds scratch memory,
/// so keep one for many polygons.
class PolygonCutter {
 public:
  PolygonCutter();
  ~PolygonCutter();
  PolygonCutter(PolygonCutter&&) noexcept;
  PolygonCutter& operator=(PolygonCutter&&) noexcept;

  /// The triples hold until the next call. Fewer than 3 corners: none. O(n log n) for usual polygons, and at most some
  /// hundred steps a corner: from there on ears are clipped unseen and diagonals stay.
  std::span<const CornerTriple> cut(std::span<const Vec3d> corners);

 private:
  void fan(std::size_t corners);
  void quad(std::span<const Vec3d> corners);
  bool project(std::span<const Vec3d> corners);

  struct Scratch;
  std::vector<CornerTriple> triples_;
  std::vector<Vec2d> flat_;
  std::unique_ptr<Scratch> scratch_;  // of polygons with five corners and more
};

}  // namespace lodestone::io
