// Resolutions for counts and errors.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/chain/voxel_levels.h"
#include "lodestone/measure/distance.h"

namespace lodestone::chain::detail {

struct VoxelCut {
  std::uint32_t resolution = 0;
  Mesh mesh;
  std::optional<measure::Distance> distance;  ///< where it was measured
};

/// The resolution at which a surface has about so many triangles, from a quick coarse solid. Errors: those of
/// VoxelLevels.
Result<std::uint32_t> predict_resolution(const Model& model, const VoxelOptions& options, std::size_t triangles,
                                         const Task& task);

/// The surface with at most so many triangles and not below nine tenths, or the nearest below found in eight tries.
/// Errors: those of VoxelLevels.
Result<VoxelCut> find_count(VoxelLevels& levels, std::size_t triangles, std::uint32_t guess, const Task& task);

/// The coarsest surface found whose measured error is within a limit; without one the finest that was tried. Errors:
/// those of VoxelLevels and of measuring.
Result<VoxelCut> find_error(VoxelLevels& levels, double limit, std::uint32_t guess, const measure::Reference& reference,
                            const measure::DistanceOptions& distance, const Task& task);

}  // namespace lodestone::chain::detail
