// Mesh: the one representation of triangle geometry. Flat arrays, no pointers, nothing derived stored.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "lodestone/core/attributes.h"
#include "lodestone/math/box.h"
#include "lodestone/math/vec.h"

namespace lodestone {

inline constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// Three wedges, counter-clockwise seen from outside.
using Triangle = std::array<std::uint32_t, 3>;

/// What a set of faces shares: one primitive of a glTF mesh, one material or group of an OBJ, one label of a volume.
struct FaceGroup {
  std::uint32_t material = kNone;  ///< index into Model::materials
  std::string name;                ///< part or group name as the file said; may be empty
  std::string object = {};         ///< `o` of an OBJ, of which this is a group; may be empty, or the same as `name`
};

/// A triangle mesh with wedges. A *vertex* is a position; a *wedge* is a vertex with one tuple of attributes; corners
/// of triangles name wedges. An edge whose two sides use different wedges is a seam: nothing else marks one.
struct Mesh {
  std::string name;
  std::vector<Vec3f> positions;             ///< one a vertex, model units, relative to `offset`
  Vec3d offset;                             ///< added to every position before the instance's transform
  std::vector<Triangle> triangles;          ///< wedge indices
  std::vector<std::uint32_t> wedge_vertex;  ///< vertex of each wedge; empty when wedge i is vertex i
  std::vector<AttributeStream> attributes;  ///< one tuple a wedge in each
  std::vector<std::uint32_t> face_group;    ///< index into `groups`, one a triangle; empty = all in group 0
  std::vector<FaceGroup> groups;            ///< may be empty when nothing is named

  std::size_t vertex_count() const { return positions.size(); }
  std::size_t wedge_count() const { return wedge_vertex.empty() ? positions.size() : wedge_vertex.size(); }
  std::uint32_t vertex_of(std::uint32_t wedge) const { return wedge_vertex.empty() ? wedge : wedge_vertex[wedge]; }
  Triangle vertices_of(std::size_t triangle) const {
    const Triangle& t = triangles[triangle];
    return {vertex_of(t[0]), vertex_of(t[1]), vertex_of(t[2])};
  }
  std::uint32_t group_of(std::size_t triangle) const { return face_group.empty() ? 0 : face_group[triangle]; }
  /// Position with the offset, in double.
  Vec3d position(std::uint32_t vertex) const { return to_double(positions[vertex]) + offset; }
};

/// Box of the vertices that a triangle uses, with the offset. O(triangles).
Box3d bounds_of(const Mesh& mesh);

/// Sum of the triangles' areas, model units squared. O(triangles).
double area_of(const Mesh& mesh);

/// Signed volume, model units cubed: tetrahedra to the centre of the bounds. Means something on closed meshes only.
double volume_of(const Mesh& mesh);

/// The stream with this semantic and set, or null.
const AttributeStream* find_stream(const Mesh& mesh, Semantic semantic, std::uint32_t set = 0);

}  // namespace lodestone
