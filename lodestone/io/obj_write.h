// OBJ out.
#pragma once

#include <filesystem>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/model.h"
#include "lodestone/io/write.h"

namespace lodestone::io {

/// Writes the whole scene as one OBJ: groups, materials in name.mtl, textures beside it, UVs and normals by corner,
/// colours behind the coordinates. Numbers in the shortest form that reads back the same. All files appear together or
/// none. Errors: empty (nothing drawn), cannot_write, cancelled.
Result<WriteReport> write_obj(const Model& model, const std::filesystem::path& path, Task task = {});

}  // namespace lodestone::io
