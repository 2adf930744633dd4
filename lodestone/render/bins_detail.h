// Which triangles may touch which tile of the picture.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "lodestone/base/task.h"
#include "lodestone/core/mesh.h"
#include "lodestone/math/vec.h"
#include "lodestone/render/projection_detail.h"

namespace lodestone::render::detail {

inline constexpr std::int32_t kTile = 32;  ///< pixels a side

/// Where within a pixel it is asked what covers it, 1/256 pixel.
struct SamplePattern {
  int count = 4;  ///< 1 or 4
  /// 4: one in each column and row of quarters. 1: the middle, with three more for lanes of other pixels.
  std::array<std::int32_t, 4> x{96, 224, 32, 160}, y{32, 96, 160, 224};
  static SamplePattern of(int samples);
};

/// A triangle whose box is at most kSmall pixels wide and high, relative to a tile's corner: edge functions fit 32
/// bits.
struct SmallTriangle {
  std::array<std::int16_t, 3> x, y;  ///< 1/256 pixel, turned so that the area is positive
  std::array<float, 3> nearness;
  std::uint32_t id;  ///< triangle of the surface
};
inline constexpr std::int32_t kSmall = 64;

/// Any other triangle (or a part of a clipped one), relative to the picture's corner.
struct LargeTriangle {
  std::array<std::int32_t, 3> x, y;
  std::array<float, 3> nearness;
  std::uint32_t id;
};

/// The triangles of one chunk of the surface, sorted by the tiles that their boxes touch.
struct ChunkBins {
  std::int32_t first_column = 0, first_row = 0, columns = 0, rows = 0;  ///< of tiles that the chunk touches
  std::vector<std::uint32_t> small_first;                               ///< one a tile of these, and the end
  std::vector<SmallTriangle> small;                                     ///< one for each tile that it touches
  std::vector<LargeTriangle> large;
  std::vector<std::uint32_t> large_first;   ///< one a row of tiles, and the end
  std::vector<std::uint32_t> large_of_row;  ///< indices into `large`, one for each row that it touches
};

struct Bins {
  std::int32_t columns = 0, rows = 0;  ///< tiles
  std::vector<ChunkBins> chunks;       ///< in the surface's order
};

/// Sorts all triangles that may cover a sample. Cut into chunks by the count of triangles alone. O(n + touched tiles).
Bins bin_triangles(const Projection& projection, const std::vector<Vec3d>& positions,
                   const std::vector<ScreenVertex>& vertices, const std::vector<Triangle>& triangles,
                   const SamplePattern& pattern, const Task& task);

}  // namespace lodestone::render::detail
