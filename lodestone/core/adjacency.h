// Adjacency built on demand from a Mesh: which triangles a vertex and an edge have. Never stored in the mesh.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lodestone/base/task.h"
#include "lodestone/core/mesh.h"

namespace lodestone {

/// Triangles around each vertex, in ascending order: offsets into one array.
struct VertexTriangles {
  std::vector<std::uint32_t> first;  ///< vertex_count + 1 offsets
  std::vector<std::uint32_t> triangles;

  std::span<const std::uint32_t> of(std::uint32_t vertex) const {
    return std::span(triangles).subspan(first[vertex], first[vertex + 1] - first[vertex]);
  }
};

/// Triangles that use a vertex twice are listed once at it. O(triangles).
VertexTriangles vertex_triangles(const Mesh& mesh);

/// An undirected edge (a < b, vertices) with the triangles that have it as a side.
struct Edge {
  std::uint32_t a, b;
  std::uint32_t first, count;  ///< into EdgeTriangles::triangles
};

/// All edges in ascending order of (a, b). Triangles with a repeated vertex are left out.
struct EdgeTriangles {
  std::vector<Edge> edges;
  std::vector<std::uint32_t> triangles;

  std::span<const std::uint32_t> of(const Edge& edge) const {
    return std::span(triangles).subspan(edge.first, edge.count);
  }
};

/// O(n log n).
EdgeTriangles edge_triangles(const Mesh& mesh, const Task& task = {});

}  // namespace lodestone
