// Normals from positions: of vertices, and of corners with sharp edges kept.
#pragma once

#include <array>
#include <vector>

#include "lodestone/base/task.h"
#include "lodestone/core/mesh.h"
#include "lodestone/spatial/surface.h"

namespace lodestone::bake::detail {

/// Unit normals, one a vertex, from all faces around it; zero where there is none with an area. Weights: Max, "Weights
/// for computing vertex normals from facet normals", 1999. O(n).
std::vector<Vec3d> vertex_normals(const Mesh& mesh);

/// Unit normals, three a triangle: the weighted sum over the faces around the corner's vertex that meet the corner's
/// face at less than 50 degrees. At vertices of more than 64 faces the face's own. O(n).
std::vector<std::array<Vec3f, 3>> crease_normals(const spatial::Surface& surface, const Task& task);

}  // namespace lodestone::bake::detail
