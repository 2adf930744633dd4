// Points and boxes of the plane.
#pragma once

#include <algorithm>
#include <array>

#include "lodestone/math/vec.h"

namespace lodestone::bake::detail {

using FlatTriangle = std::array<Vec2d, 3>;

inline Vec2d operator-(Vec2d a, Vec2d b) { return {a.x - b.x, a.y - b.y}; }
inline double cross(Vec2d a, Vec2d b) { return a.x * b.y - a.y * b.x; }
inline double dot(Vec2d a, Vec2d b) { return a.x * b.x + a.y * b.y; }

struct PlaneBox {
  Vec2d min{1e300, 1e300}, max{-1e300, -1e300};
  void add(Vec2d p) {
    min = {std::min(min.x, p.x), std::min(min.y, p.y)};
    max = {std::max(max.x, p.x), std::max(max.y, p.y)};
  }
  Vec2d size() const { return max - min; }
};

template <class Points>
PlaneBox box_of(const Points& points) {
  PlaneBox box;
  for (const Vec2d& p : points) box.add(p);
  return box;
}

}  // namespace lodestone::bake::detail
