// Counts that describe a mesh's connectivity, by vertices (positions), as an independent checker would count them.
#pragma once

#include <cstdint>

#include "lodestone/base/task.h"
#include "lodestone/core/mesh.h"

namespace lodestone {

struct Topology {
  std::uint64_t vertices = 0;              ///< used by at least one triangle
  std::uint64_t wedges = 0;                ///< used by at least one triangle
  std::uint64_t triangles = 0;             ///< all, degenerate ones included
  std::uint64_t degenerate_triangles = 0;  ///< a vertex twice, or cross product exactly 0 in double
  std::uint64_t duplicate_faces = 0;       ///< triangles whose three vertices are those of an earlier one, in any order
  // The following leave out triangles with a repeated vertex.
  std::uint64_t edges = 0;
  std::uint64_t boundary_edges = 0;        ///< exactly one triangle
  std::uint64_t nonmanifold_edges = 0;     ///< three or more triangles
  std::uint64_t inconsistent_edges = 0;    ///< two triangles walking it the same way
  std::uint64_t nonmanifold_vertices = 0;  ///< whose opposite edges are not one path or ring
  std::uint64_t components = 0;            ///< pieces connected through shared vertices
  /// Edges with one triangle once doubled faces are told apart from sheets: faces with the same three vertices count
  /// once, or not at all where as many face either way and their part has other faces. 0 without doubled faces.
  std::uint64_t hidden_boundary_edges = 0;
  bool closed = false;    ///< at least one triangle, no boundary edge, and none hidden by doubled faces
  bool manifold = false;  ///< at least one triangle, no non-manifold edge or vertex
};

/// O(n log n).
Topology topology_of(const Mesh& mesh, const Task& task = {});

}  // namespace lodestone
