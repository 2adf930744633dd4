// Bare Draco files (.drc).
#pragma once

#include <filesystem>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/model.h"

namespace lodestone::io {

/// Reads a bare Draco mesh: one mesh, one instance, all attributes.
/// Errors: cannot_read, bad_format, unsupported (built without Draco), empty (a point cloud or no triangle), cancelled.
Result<Model> read_drc(const std::filesystem::path& path, Task task = {});

/// The same from bytes; `name` stands in errors.
Result<Model> read_drc_bytes(std::string_view bytes, const std::string& name, Task task = {});

}  // namespace lodestone::io
