// How far a triangle of a level is from the original, and where.
#pragma once

#include "lodestone/math/vec.h"

namespace lodestone::simplify {

/// The largest distance found at a triangle: where on it, and the point of the original there.
struct TriangleError {
  float distance = 0;           ///< mesh units
  float second = 0, third = 0;  ///< where: weights of the triangle's second and third corner
  Vec3d partner;                ///< on the original
};

}  // namespace lodestone::simplify
