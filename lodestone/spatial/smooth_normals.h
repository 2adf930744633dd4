// Normals from positions: of vertices, and of corners with sharp edges kept.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "lodestone/base/task.h"
#include "lodestone/core/mesh.h"
#include "lodestone/spatial/surface.h"

namespace lodestone::spatial {

/// Unit normals, one a vertex, from all faces around it; zero where there is none with an area. Weights: Max, "Weights
/// for computing vertex normals from facet normals", 1999. O(n).
std::vector<Vec3d> vertex_normals(const Mesh& mesh);

/// A normal for each corner: the weighted sum (as above) over the faces around the vertex that meet the corner's face
/// at less than 50 degrees, so that round things look round and edges sharp. Corners at vertices of more than 64 faces
/// (tips of cones), get their face's. Made on request, as a list of all would take three times a mesh's own memory.
class CreaseNormals {
 public:
  /// Keeps a reference to the surface. O(n), on threads.
  explicit CreaseNormals(const Surface& surface, const Task& task);
  /// Of length 1; zero at faces without area. O(faces around the vertex).
  Vec3d at(std::size_t triangle, std::size_t corner) const;

 private:
  // A face's unit normal, and how much of it goes to each corner.
  struct Face {
    Vec3f normal;
    std::array<float, 3> weight{};
  };
  const Surface& surface_;
  std::vector<Face> faces_;
  std::vector<std::uint32_t> first_, list_;  // triangles at vertex v: list_[first_[v] .. first_[v + 1])
};

}  // namespace lodestone::spatial
