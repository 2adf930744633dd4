// STL out.
#pragma once

#include <filesystem>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/model.h"
#include "lodestone/io/write.h"

namespace lodestone::io {

/// Writes the whole scene as binary STL: triangles with their geometric normals; attributes, names and materials are
/// left out. Errors: bad_argument (those of validate()), empty (nothing drawn), cannot_write, unsupported (over 2^32
/// triangles), cancelled.
Result<WriteReport> write_stl(const Model& model, const std::filesystem::path& path, Task task = {});

}  // namespace lodestone::io
