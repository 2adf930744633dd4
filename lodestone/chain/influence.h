// What users tell edge collapse of a model: where it matters more, what stays, what counts as one.
#pragma once

#include <string>
#include <vector>

#include "lodestone/base/result.h"
#include "lodestone/core/model.h"

namespace lodestone::chain {

/// A ball in world space (default scene) in which vertices weigh `weight`, or stay where they are.
struct InfluenceSphere {
  Vec3d center;
  double radius = 0;  ///< model units
  double weight = 1;  ///< 0 or more; of several spheres the largest counts
  bool locked = false;
};

struct Influence {
  std::vector<InfluenceSphere> spheres;
  std::string weight_attribute;  ///< name of a stream of one component whose values are weights; empty = none
  bool keep_border = false;      ///< open borders stay as they are
  double weld_tolerance = 0;  ///< model units: vertices nearer than this are one in coarser levels; 0 = only equal ones

  bool weighs() const { return !spheres.empty() || !weight_attribute.empty(); }
};

/// What edge collapse is told of one mesh, one entry a vertex; empty where nothing is to be told.
struct VertexInfluence {
  std::vector<float> weights;
  std::vector<std::uint8_t> locked;
};

/// One entry a mesh. A vertex is in a sphere when any instance places it there. Outside all spheres, and in meshes
/// without the attribute, the weight is 1. Errors: bad_argument (no mesh has the attribute; a value is negative).
Result<std::vector<VertexInfluence>> vertex_influences(const Model& model, const Influence& influence);

}  // namespace lodestone::chain
