// Levels by voxels: what --method voxel of `build` takes.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/bake_run.h"
#include "app/command_line.h"
#include "app/shared_options.h"
#include "app/spec.h"
#include "lodestone/base/result.h"
#include "lodestone/chain/remesh.h"

namespace lodestone::app {

/// --method, and what belongs to voxels.
OptionGroup voxel_method_group();

/// Nothing where levels are made by edge collapse. Errors: bad_argument (options of one method with the other).
struct VoxelMethod {
  chain::VoxelOptions voxel;
  BakePlan bake;
  bool then_collapse = false;
  std::uint32_t resolution = 0;  ///< 0 = by the targets
};
Result<std::optional<VoxelMethod>> voxel_method(const Arguments& arguments);

}  // namespace lodestone::app
