// New surfaces of models by way of voxels ([voxel-lod]): whatever the input, closed and manifold.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/chain/voxels/voxel_levels.h"
#include "lodestone/core/level.h"
#include "lodestone/measure/distance.h"

namespace lodestone::chain {

struct RemeshOptions {
  std::uint32_t resolution =
      0;                      ///< voxels along the longest side, the margin of one counted; 0 = by the target, or 128
  std::size_t triangles = 0;  ///< at most so many, and not below nine tenths; 0 = no such target
  double error = 0;           ///< the coarsest whose measured error is within it, model units; 0 = no such target
  /// Reach the target by collapsing edges of a surface with a resolution that is given, or as fine as sixteen times the
  /// target's count (200,000 to 4 million triangles; eight times where holes are closed) or a third of its error need.
  bool then_collapse = false;
  bool prune = false;  ///< with it: parts vanish where that errs no more than the level does
  VoxelOptions voxel;
  bool measure = true;
  measure::DistanceOptions distance;
};

struct RemeshResult {
  Level level;                                ///< method "voxels" or "voxels and edge collapse"
  bool measured = true;                       ///< false: level.error means nothing
  std::uint32_t level_resolution = 0;         ///< of the surface, along the longest side
  std::array<std::uint32_t, 3> resolution{};  ///< of the solid
  std::uint64_t voxels_inside = 0;
  FillChoice fill;
  std::vector<std::string> warnings;  ///< what had to be assumed, what vanished
  std::string shortfall;              ///< empty = the target was reached
  VoxelSeconds seconds;
};

/// Voxelizes the model's default scene and contours it. A count is predicted from coarser runs, as triangles grow with
/// the square of the resolution ([voxel-lod], section 3.4); an error is found by measuring. Errors: bad_argument (both
/// targets; then_collapse without one; a resolution beside a target without it; options out of range; those of
/// validate()), empty, out_of_memory, cancelled.
Result<RemeshResult> remesh(const Model& model, const RemeshOptions& options = {}, Task task = {});

}  // namespace lodestone::chain
