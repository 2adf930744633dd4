// Triangles: area, normal, closest point.
#pragma once

#include <array>

#include "lodestone/math/vec.h"

namespace lodestone {

/// Twice the area times the unit normal (counter-clockwise is outward).
template <class T>
constexpr Vec3<T> scaled_normal(Vec3<T> a, Vec3<T> b, Vec3<T> c) {
  return cross(b - a, c - a);
}

/// Squared distance from p to the triangle abc and the closest point. Any triangle, degenerate ones too (then the
/// closest point on its sides). Source: the case analysis over the triangle's Voronoi regions, Ericson 2005,
/// section 5.1.5.
struct ClosestPoint {
  Vec3d point;
  double distance_sq;
};
ClosestPoint closest_point(Vec3d p, Vec3d a, Vec3d b, Vec3d c);

/// Weights of a, b and c, none negative, sum 1, whose mean is a point p of the triangle. For a p that is off the
/// triangle by rounding, and for a triangle without area, those of a point near it.
std::array<double, 3> barycentric(Vec3d p, Vec3d a, Vec3d b, Vec3d c);

}  // namespace lodestone
