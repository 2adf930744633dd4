// Which way is up in files that don't say.
#pragma once

#include <filesystem>

#include "app/options/command_line.h"
#include "app/options/spec.h"
#include "lodestone/base/result.h"
#include "lodestone/core/model.h"

namespace lodestone::app {

enum class UpAxis { unsaid, y, z };

OptionGroup axes_group();  ///< --up
UpAxis up_axis(const Arguments& arguments);

/// Says which way is up in a model that was read from `path`; its coordinates stay. Errors: bad_argument (the format
/// has a rule of its own).
Result<void> apply_up(Model& model, UpAxis up, const std::filesystem::path& path);

}  // namespace lodestone::app
