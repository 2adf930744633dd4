// Long thin triangles as several boxes: along a diagonal one box of a sliver is nearly empty, and where thousands of
// them lie side by side every query would meet all.
#pragma once

#include <cstdint>
#include <vector>

#include "lodestone/base/task.h"
#include "lodestone/math/box.h"
#include "lodestone/spatial/surface.h"

namespace lodestone::spatial::detail {

/// A part of a triangle: its box.
struct Piece {
  Box3d box;
  std::uint32_t triangle = 0;
};

/// All triangles of the surface as pieces, along a Hilbert curve, where many are so thin and slanted that it pays;
/// otherwise nothing. At most 5 n + 1,000,000 pieces, 60 bytes each while the tree is built. O(n log n).
/// Source: [ernst-greiner-2007], boxes of parts of a triangle.
std::vector<Piece> thin_pieces(const Surface& surface, const Task& task);

}  // namespace lodestone::spatial::detail
