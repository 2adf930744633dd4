// Splitting triangles at the middles of their sides, without cracks.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "lodestone/base/task.h"
#include "lodestone/core/mesh.h"

namespace lodestone::measure::detail {

/// A side by its two vertices, low < high.
struct EdgeKey {
  std::uint32_t low = 0, high = 0;
  auto operator<=>(const EdgeKey&) const = default;
};

inline EdgeKey edge_of(std::uint32_t a, std::uint32_t b) { return {std::min(a, b), std::max(a, b)}; }

inline Vec3d middle_of(const std::vector<Vec3d>& positions, const EdgeKey& side) {
  return (positions[side.low] + positions[side.high]) * 0.5;
}

void sort_unique(std::vector<EdgeKey>& sides, const Task& task);

/// All triangles, each cut in two, three or four where `sides` (sorted, each once) names sides of it. The middle of
/// sides[i] is vertex first + i. Faces keep their direction. O(triangles · log sides).
std::vector<Triangle> split_sides(std::span<const Triangle> triangles, std::span<const EdgeKey> sides,
                                  std::size_t first);

}  // namespace lodestone::measure::detail
