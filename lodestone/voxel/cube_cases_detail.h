// The 256 ways in which a surface can pass between the corners of a cube.
#pragma once

#include <array>
#include <cstdint>

namespace lodestone::voxel::detail {

/// Corner c of the cube lies at (c & 1, c >> 1 & 1, c >> 2 & 1). Edge e runs along axis e / 4, from corner
/// kEdgeCorner[e] upwards.
inline constexpr std::array<std::uint8_t, 12> kEdgeCorner{0, 2, 4, 6, 0, 1, 4, 5, 0, 1, 2, 3};

struct CubeCase {
  std::uint8_t triangles = 0;                          ///< at most 5
  std::array<std::array<std::uint8_t, 3>, 5> edges{};  ///< where the corners of each triangle lie; faces look outward.
  // Ring by ring in the order of cube_loops(), of each two triangles less than edges.
};

/// The rings of crossed edges in which the surface leaves a cube, in the order of its border.
struct CubeLoops {
  std::uint8_t count = 0;                ///< at most 4
  std::array<std::uint8_t, 4> length{};  ///< at least 3 each, 12 in all
  std::array<std::uint8_t, 12> edges{};  ///< one ring after the other
};

/// By which corners are inside, bit c for corner c. Two cubes that share a face cut it along the same lines, as each
/// inside corner of a face whose inside corners lie opposite is cut off by itself. No triangle has a side in a face but
/// on those lines, so closed surfaces have two triangles at every edge.
const std::array<CubeCase, 256>& cube_cases();
const std::array<CubeLoops, 256>& cube_loops();

}  // namespace lodestone::voxel::detail
