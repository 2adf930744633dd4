// The options of verbs that work on voxels.
#pragma once

#include <optional>
#include <string>

#include "app/command_line.h"
#include "app/spec.h"
#include "lodestone/base/result.h"
#include "lodestone/voxel/voxelize.h"

namespace lodestone::app {

OptionGroup voxel_group();   ///< --resolution, --fill
OptionGroup remesh_group();  ///< and --supersample, --no-project

/// Errors: bad_argument.
Result<std::uint32_t> resolution_of(const Arguments& arguments);

/// Nothing without --fill.
std::optional<voxel::FillRule> fill_of(const Arguments& arguments);
std::string name_of(voxel::FillRule fill);

}  // namespace lodestone::app
