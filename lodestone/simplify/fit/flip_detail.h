// Edges turned over where that brings a level nearer to its original.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "lodestone/simplify/fit/correspondences_detail.h"

namespace lodestone::simplify::detail {

/// Low and high vertex of edges that are not turned, sorted.
using NoFlipEdges = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

/// Turns edges over where the squared distances of the correspondences around fall by two per cent, no larger distance
/// appears, no edge is doubled, and no face turns away, folds or becomes much thinner; no triangle twice. Edges whose
/// four vertices are all `no_move` are not turned. `wedges` goes along with level.triangles. Returns the pairs of
/// triangles that changed. O(triangles log triangles of the target).
std::vector<TrianglePair> flip_edges(const FitTarget& target, const Correspondences& correspondences,
                                     const NoFlipEdges& no_flip, std::span<const std::uint8_t> no_move,
                                     spatial::Surface& level, std::vector<Triangle>& wedges, const Task& task);

}  // namespace lodestone::simplify::detail
