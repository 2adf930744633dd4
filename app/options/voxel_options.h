// The options of verbs that work on voxels.
#pragma once

#include <optional>
#include <string>

#include "app/options/command_line.h"
#include "app/options/shared_options.h"
#include "app/options/spec.h"
#include "lodestone/base/result.h"
#include "lodestone/chain/voxels/voxel_levels.h"
#include "lodestone/voxel/voxelize.h"

namespace lodestone::app {

OptionGroup resolution_group();     ///< --resolution
OptionGroup solid_group();          ///< --fill, --close
OptionGroup level_group();          ///< --supersample, --place, --keep-thin, --keep-volume, --then-collapse
OptionGroup remesh_target_group();  ///< --resolution, --triangles, --error

/// Errors: bad_argument.
Result<std::uint32_t> resolution_of(const Arguments& arguments);

/// Nothing without --fill.
std::optional<voxel::FillRule> fill_of(const Arguments& arguments);
std::string name_of(voxel::FillRule fill);

/// What the options of solid_group() and level_group() say, for a model (--close may be relative). Errors:
/// bad_argument.
Result<chain::VoxelOptions> voxel_options(const Arguments& arguments, const LengthRules& lengths, const Model& model);

/// --close in model units; 0 without. Errors: bad_argument.
Result<double> close_of(const Arguments& arguments, const LengthRules& lengths, const Model& model, double diagonal);

}  // namespace lodestone::app
