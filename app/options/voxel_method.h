// Levels by voxels: what --method voxel of `build` takes.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/options/command_line.h"
#include "app/options/shared_options.h"
#include "app/options/spec.h"
#include "app/options/surface_attributes.h"
#include "lodestone/base/result.h"
#include "lodestone/chain/voxels/voxel_ladder.h"

namespace lodestone::app {

/// --method, and what belongs to voxels.
OptionGroup voxel_method_group();

/// Nothing where levels are made by edge collapse. Errors: bad_argument (options of one method with the other).
Result<std::optional<chain::VoxelLadderOptions>> voxel_method(const Arguments& arguments);

}  // namespace lodestone::app
