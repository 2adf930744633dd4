// What new surfaces take over from the model that they were made from: normals, colours, textures.
#pragma once

#include <string>
#include <vector>

#include "app/options/command_line.h"
#include "app/options/spec.h"
#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/chain/voxels/surface_attributes.h"
#include "lodestone/core/model.h"

namespace lodestone::app {

/// --texture-size and --no-attributes.
OptionGroup baked_group();

/// What the options ask for, textures as PNG. Errors: bad_argument.
Result<chain::SurfaceAttributeOptions> surface_attributes(const Arguments& arguments);

/// Decodes the model's textures if surfaces are to take colours from it. Warnings tell of those that can't be decoded.
/// Errors: those of io::decode_base_colors().
Result<void> decode_for(const chain::SurfaceAttributeOptions& options, Model& model, std::vector<std::string>& warnings,
                        const Task& task);

}  // namespace lodestone::app
