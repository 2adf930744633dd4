// Pictures as outputs: their place, and what they must not replace.
#pragma once

#include <string>
#include <vector>

#include "app/children/volume_input.h"
#include "app/options/command_line.h"
#include "app/output/console.h"
#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/model.h"

namespace lodestone::app {

/// What -o names, checked before any work: a format of pictures, a place that can be written. Errors: bad_argument,
/// cannot_write.
Result<std::string> picture_output(const Arguments& arguments);

/// That the picture replaces no file of a model that was read, be it a texture. Errors: cannot_write.
Result<void> check_picture_kept(const Model& model, const std::string& output);

/// Reads a level of a model (0: the model itself), with its textures. What is amiss is told and added to `warnings`.
/// Errors: bad_argument (no such level), those of reading.
Result<Model> read_drawn_level(const std::string& input, std::size_t level, std::vector<std::string>& warnings,
                               const Console& console, const Task& task, const VolumeRequest& volume = {});

}  // namespace lodestone::app
