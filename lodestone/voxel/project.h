// Moving a contoured surface onto the one that it came from.
#pragma once

#include "lodestone/base/task.h"
#include "lodestone/core/mesh.h"
#include "lodestone/spatial/bvh.h"

namespace lodestone::voxel {

/// Moves each vertex to the closest point of `source`, at most `most` (model units, about a voxel) far; one whose move
/// would turn a triangle around it by more than a right angle stays, and so does what is farther away. Connectivity is
/// left alone. Same bytes for any thread count. O(vertices log triangles). Returns how many were moved.
std::size_t project(Mesh& mesh, const spatial::Bvh& source, double most, const Task& task = {});

}  // namespace lodestone::voxel
