// Triangles of a surface that pass through each other, or lie on each other.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "lodestone/base/task.h"
#include "lodestone/spatial/bvh.h"

namespace lodestone::spatial {

/// Whether a side of one triangle passes through the other, by the signs of tetrahedra's volumes. Touching is no
/// crossing, nor is lying in one plane. In double precision: triangles within rounding of touching may count either as
/// crossing or as not.
bool triangles_intersect(const std::array<Vec3d, 3>& a, const std::array<Vec3d, 3>& b);

/// Pairs of triangles of the tree's surface that cross and share no vertex, the lower number first, in order; only
/// those with one that is `wanted` (one a triangle, non-zero = wanted; empty = all). O(n log n) if few boxes overlap.
std::vector<std::array<std::uint32_t, 2>> self_intersections(const Bvh& tree, std::span<const std::uint8_t> wanted,
                                                             const Task& task);

/// Pairs of triangles that meet at an edge and lie on each other, by an angle of less than 10 degrees, the lower number
/// first, in order. O(n).
std::vector<std::array<std::uint32_t, 2>> folds(const Surface& surface);

}  // namespace lodestone::spatial
