// What users tell edge collapse of a model: where it matters more, what must not move, what is joined, what may vanish.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "lodestone/base/result.h"
#include "lodestone/core/model.h"
#include "lodestone/simplify/collapse/edge_collapse.h"

namespace lodestone::chain {

/// A ball in world space (default scene) in which vertices weigh `weight`, or do not move.
struct ConstraintSphere {
  Vec3d center;
  double radius = 0;  ///< model units
  double weight = 1;  ///< 0 or more; of several spheres the largest counts
  bool no_move = false;
};

/// Numbers of triangles, first and last included.
struct TriangleRange {
  std::uint64_t first = 0, last = 0;
};

/// What coarser levels have for tangents.
enum class Tangents {
  interpolated,  ///< those of the original, as normal maps were made for them, orthogonal to the normals
  rebuilt,       ///< made anew from normals and texture coordinates
  dropped,       ///< none: viewers make their own
};

struct SimplifyConstraints {
  std::vector<ConstraintSphere> spheres;
  std::string weight_attribute;  ///< name of a stream of one component whose values are weights; empty = none
  bool keep_border = false;      ///< vertices of open borders neither move nor vanish
  double weld_tolerance = 0;  ///< model units: vertices nearer than this are one in coarser levels; 0 = only equal ones
  double join_length = 0;     ///< model units: borders of different parts nearer than this are sewn together; 0 = none
  bool prune = false;         ///< parts vanish when that errs no more than the collapses of a level do
  bool keep_area = false;     ///< and those that are left grow to the area that they stand for; implies prune
  /// The triangles that may change, counted from 0 over the model's meshes in order, each mesh once however often it is
  /// drawn; all others are left as they are to the bit. Empty = all may.
  std::vector<TriangleRange> only;

  simplify::AttributeWeights attribute_weights;
  std::size_t max_skin_influences =
      4;  ///< skin influences of a wedge in coarser levels; 0, or with `only`: as they are
  Tangents tangents = Tangents::interpolated;  ///< with `only`: interpolated

  bool vanishes() const { return prune || keep_area; }
};

/// What edge collapse is told of one mesh, one entry a vertex; empty where nothing is to be told.
struct VertexConstraints {
  std::vector<float> weights;
  std::vector<std::uint8_t> no_move;
};

/// One entry a mesh. A vertex is in a sphere when any instance places it there. Outside all spheres, and in meshes
/// without the attribute, the weight is 1. Errors: bad_argument (no mesh has the attribute; a value is negative; those
/// of untouched_triangles() and validate()).
Result<std::vector<VertexConstraints>> vertex_constraints(const Model& model, const SimplifyConstraints& constraints);

/// The triangles of each mesh that `constraints.only` doesn't name, non-zero = must not change; empty when it names
/// none. Errors: bad_argument (a number past the last triangle, a range that falls).
Result<std::vector<std::vector<std::uint8_t>>> untouched_triangles(const Model& model,
                                                                   const SimplifyConstraints& constraints);

/// Non-zero for the vertices of marked triangles; empty when `marked` is.
std::vector<std::uint8_t> vertices_of_triangles(const Mesh& mesh, const std::vector<std::uint8_t>& marked);

/// Numbers of the spheres in which no drawn vertex lies, ascending: a typing error, as a rule.
std::vector<std::size_t> empty_spheres(const Model& model, const std::vector<ConstraintSphere>& spheres);

}  // namespace lodestone::chain
