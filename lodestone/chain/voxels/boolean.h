// Booleans of models as solids of voxels.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/chain/voxels/voxel_levels.h"
#include "lodestone/core/model.h"
#include "lodestone/voxel/boolean.h"

namespace lodestone::chain {

struct BooleanOptions {
  std::uint32_t resolution = 128;                     ///< voxels along the longest side of all models together
  std::vector<voxel::BooleanOperation> operations{};  ///< one less than models; from left to right
  VoxelOptions voxel;
};

struct BooleanResult {
  Model model;
  std::array<std::uint32_t, 3> resolution{};  ///< of the solids
  std::uint64_t voxels_inside = 0;
  FillChoice fill;  ///< of the first model
  std::vector<std::string> warnings;
  VoxelSeconds seconds;
};

/// Solids of all models in one grid, combined, contoured, and moved onto the surfaces of the models. Closed and
/// manifold. Errors: bad_argument (no models, operations that don't fit, units that differ; those of validate()), empty
/// (nothing left), out_of_memory, cancelled.
Result<BooleanResult> boolean(std::span<const Model> models, const BooleanOptions& options, Task task = {});

}  // namespace lodestone::chain
