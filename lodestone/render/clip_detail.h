// Triangles that reach behind the eye or far off the picture.
#pragma once

#include <array>
#include <cstddef>

#include "lodestone/math/vec.h"
#include "lodestone/render/projection_detail.h"

namespace lodestone::render::detail {

/// A convex polygon on the picture; empty when nothing is left.
struct ClippedPolygon {
  std::array<ScreenVertex, 8> corners;
  std::size_t count = 0;
};

/// What is left of a triangle in front of the near plane and within the guard band. Triangles that share a side get the
/// same points on it. Corners that are not finite leave nothing.
ClippedPolygon clip(const Projection& projection, const std::array<Vec3d, 3>& world);

}  // namespace lodestone::render::detail
