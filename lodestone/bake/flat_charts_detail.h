// Charts laid out in the plane.
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "lodestone/bake/charts_detail.h"
#include "lodestone/base/task.h"
#include "lodestone/core/mesh.h"

namespace lodestone::bake::detail {

/// A chart seen along its axis from outside, model units, turned so that its box is small and not wider than high. Its
/// triangles wind counter-clockwise (y upward) and no two of them overlap.
struct FlatChart {
  std::vector<std::uint32_t> triangles;
  std::vector<std::array<Vec2d, 3>> corners;     ///< one a triangle; the box begins at (0, 0)
  std::vector<std::pair<Vec2d, Vec2d>> outline;  ///< the sides that have no neighbour in the chart
  Vec2d size;                                    ///< of the box
  double area = 0;                               ///< of the triangles, flat
};

/// Lays out each chart; one that would overlap itself is split. `chart` has the number of each triangle's chart; what
/// was split off follows the chart that it comes from. Same result for any thread count. About linear where triangles
/// of a chart are of a size.
std::vector<FlatChart> flatten_charts(const Mesh& mesh, const Neighbors& neighbors,
                                      const std::vector<std::uint32_t>& chart, const Task& task);

}  // namespace lodestone::bake::detail
