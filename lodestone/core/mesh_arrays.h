// Meshes from the arrays of a host program, and back.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/attributes.h"
#include "lodestone/core/mesh.h"

namespace lodestone {

/// Floats of a host program, `components` in a row for each vertex. Read once, never kept.
struct FloatArray {
  const float* data = nullptr;
  std::size_t stride_bytes = 0;  ///< from one vertex to the next; 0 = the components lie side by side
};

/// One attribute of the vertices.
struct AttributeArray {
  std::string name;  ///< as files name it: "NORMAL", "TEXCOORD_0", "COLOR_0"; "quality"
  Semantic semantic = Semantic::generic;
  std::uint32_t set = 0;         ///< n of TEXCOORD_n, COLOR_n
  std::uint32_t components = 1;  ///< 3 for normals, 2 for texture coordinates, 3 or 4 for colours
  FloatArray values;             ///< colours from 0 to 1
};

/// Triangles as graphics programs have them: vertices, each with one tuple of attributes, and three indices a triangle.
struct MeshArrays {
  std::size_t vertices = 0;
  FloatArray positions;                    ///< three a vertex, model units
  std::span<const std::uint32_t> indices;  ///< three a triangle, counter-clockwise seen from outside
  std::vector<AttributeArray> attributes;  ///< no joints, weights or ids, whose values are no floats
};

struct FromArraysOptions {
  /// Vertices at equal positions become one vertex, whose different attributes are wedges: seams of attributes are no
  /// cracks then, and what no triangle uses goes. False: each vertex stays by itself, in its order, and a seam is an
  /// open border, which collapses treat as one.
  bool weld = true;
};

/// A mesh that validate() accepts. Errors: bad_argument (no position array, indices that are no triples or name
/// vertices that aren't there, a stride below the size of a tuple or no multiple of four, an attribute without values
/// or of a kind that floats can't be, counts beyond 32 bits, positions that are not finite), cancelled. O(vertices +
/// triangles).
Result<Mesh> from_arrays(const MeshArrays& arrays, const FromArraysOptions& options = {}, Task task = {});

/// What to_arrays() returns: as many vertices as the mesh has wedges.
struct MeshBuffers {
  struct Attribute {
    std::string name;
    Semantic semantic = Semantic::generic;
    std::uint32_t set = 0, components = 1;
    std::vector<float> values;  ///< `components` a vertex
  };
  std::vector<float> positions;        ///< three a vertex, relative to `offset`
  Vec3d offset;                        ///< of the mesh: zero unless its coordinates are far from the origin
  std::vector<std::uint32_t> indices;  ///< three a triangle
  std::vector<Attribute> attributes;   ///< the mesh's, but for those that aren't floats
};

/// The mesh as arrays for drawing. from_arrays() of them gives the same positions, triangles and attributes. The mesh
/// must be valid. O(wedges + triangles).
MeshBuffers to_arrays(const Mesh& mesh);

}  // namespace lodestone
