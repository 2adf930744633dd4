// Where on a triangle a point of the picture lies.
#pragma once

#include <array>

#include "lodestone/math/vec.h"
#include "lodestone/render/raster_detail.h"

namespace lodestone::render::detail {

struct Fragment {
  std::array<float, 3> weight;  ///< of the triangle's corners, none negative, sum 1; right in perspective
  bool back = false;            ///< seen from behind

  template <class T>
  T mix(const T& a, const T& b, const T& c) const {
    return a * weight[0] + b * weight[1] + c * weight[2];
  }
};

/// At (x, y) pixels of the picture; points beside the triangle (or behind the eye) count as on its rim.
Fragment fragment_at(const Raster& raster, std::uint32_t triangle, Vec2f at);

/// Distances in pixels to the lines through the triangle's sides (side k across from corner k), and the least height of
/// the triangle as drawn.
struct SideDistances {
  std::array<float, 3> to_side;
  float height;
};
SideDistances side_distances(const Raster& raster, std::uint32_t triangle, Vec2f at);

}  // namespace lodestone::render::detail
