// Charts: a surface cut into pieces that are nearly flat, so that each can be laid out in a plane.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "lodestone/base/task.h"
#include "lodestone/core/mesh.h"

namespace lodestone::bake::detail {

/// For each triangle's side k (corners k and k + 1) the triangle beyond it; kNone where there is none or where several
/// meet.
using Neighbors = std::vector<std::array<std::uint32_t, 3>>;
Neighbors neighbors_of(const Mesh& mesh, const Task& task);

/// Number of the chart of each triangle, counted in order of first use. Each chart is connected over sides, and each of
/// its triangles faces the chart's axis (the mean of its normals by area) to within 80 degrees, most to within 67.
///
/// Bottom-up clustering as in Garland, Willmott & Heckbert, "Hierarchical face clustering on polygonal surfaces", 2001,
/// with the error of Cohen-Steiner, Alliez & Desbrun, "Variational shape approximation", 2004 (area minus the length of
/// the summed normals) and perimeters that keep charts compact. O(n log n).
std::vector<std::uint32_t> make_charts(const Mesh& mesh, const Neighbors& neighbors, const Task& task);

}  // namespace lodestone::bake::detail
