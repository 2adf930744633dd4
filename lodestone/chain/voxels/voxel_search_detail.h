// Resolutions for counts and errors, and what is told of what they give.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/chain/voxels/voxel_levels.h"
#include "lodestone/measure/distance.h"

namespace lodestone::chain::detail {

/// What a surface by voxels is to be; none of the three = 128 voxels.
struct VoxelTarget {
  std::uint32_t resolution = 0;  ///< voxels along the longest side; 0 = by the other two
  std::size_t triangles = 0;     ///< at most so many; 0 = no such target
  double error = 0;              ///< measured maximum, model units; 0 = no such target
  bool then_collapse = false;    ///< the surface is the fine one that edges are collapsed of to reach the target
};

struct VoxelCut {
  std::uint32_t resolution = 0;  ///< along the longest side
  Mesh mesh;
  std::optional<measure::Distance> distance;  ///< where it was measured
};

/// The finest resolution that a target needs, from quick coarse solids: triangles grow with the square of the
/// resolution ([voxel-lod], section 3.4). Errors: those of VoxelLevels.
Result<std::uint32_t> finest_for(const Model& model, const VoxelOptions& options, const VoxelTarget& target,
                                 const Task& task);

/// True where cut_for() measures, and so needs a reference.
bool needs_reference(const VoxelTarget& target);

/// The surface for a target; `finest` as finest_for() gave it. A count is met from below within a tenth, or as nearly
/// as eight tries come; an error by the coarsest surface found within it, or, told by its distance, the finest one
/// tried. Errors: those of VoxelLevels and of measuring.
Result<VoxelCut> cut_for(VoxelLevels& levels, const VoxelTarget& target, std::uint32_t finest,
                         const measure::Reference* reference, const measure::DistanceOptions& distance,
                         const Task& task);

/// Why a cut is not what was asked; empty when it is.
std::string shortfall_of(const VoxelTarget& target, const VoxelCut& cut);

/// Adds to the warnings which pieces of the model have nothing left.
void tell_vanished(const VoxelLevels& levels, const Model& model, const VoxelCut& cut,
                   std::vector<std::string>& warnings);

}  // namespace lodestone::chain::detail
