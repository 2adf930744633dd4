// OFF out.
#pragma once

#include <filesystem>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/model.h"
#include "lodestone/io/write.h"

namespace lodestone::io {

/// Writes the whole scene as OFF: positions and triangles only. Numbers in the shortest form that reads back the same.
/// Errors: bad_argument (those of validate()), empty (nothing drawn), cannot_write, cancelled.
Result<WriteReport> write_off(const Model& model, const std::filesystem::path& path, Task task = {});

}  // namespace lodestone::io
