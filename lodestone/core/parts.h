// The pieces that a mesh falls into.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "lodestone/core/mesh.h"

namespace lodestone {

/// Pieces connected through shared vertices, numbered by their lowest vertex.
struct Parts {
  std::vector<std::uint32_t> of_vertex;  ///< part of each vertex; kNone where no proper triangle uses it
  std::size_t count = 0;

  /// Of a triangle with three different vertices.
  std::uint32_t of_triangle(const Mesh& mesh, std::size_t triangle) const {
    return of_vertex[mesh.vertex_of(mesh.triangles[triangle][0])];
  }
};

/// Triangles that use a vertex twice connect nothing. O(n).
Parts parts_of(const Mesh& mesh);

}  // namespace lodestone
