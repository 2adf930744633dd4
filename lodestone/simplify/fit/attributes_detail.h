// Attributes of vertices that have moved.
#pragma once

#include <vector>

#include "lodestone/base/task.h"
#include "lodestone/core/mesh.h"
#include "lodestone/simplify/fit/target.h"

namespace lodestone::simplify::detail {

/// Wedges of vertices that are not where they were (`before`, one a vertex) take on by how much normals, UVs, colours
/// and other numbers differ on the original between the points closest to both places, if these are in one chart. So
/// textures don't swim, and differences that collapses have chosen remain. O(vertices log triangles).
void carry_attributes(const FitTarget& target, const std::vector<Vec3f>& before, Mesh& level, const Task& task);

}  // namespace lodestone::simplify::detail
