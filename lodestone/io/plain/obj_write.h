// OBJ out.
#pragma once

#include <filesystem>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/model.h"
#include "lodestone/io/write.h"

namespace lodestone::io {

/// Writes the whole scene as one OBJ: parts, groups, materials in name.mtl with the lines that an MTL gave, textures
/// beside it, UVs and normals by corner,
/// colours behind the coordinates. Where only some groups have a name or a material, the others are in a group
/// "default" with a white material "none" (with '_' appended where these are taken). Numbers in the shortest form that
/// reads back the same. All files appear together or none. Warns of attributes that OBJ has no place for, of colours'
/// alpha, and of vertices whose wedges differ in colour. Errors: bad_argument (those of validate()), empty (nothing
/// drawn), cannot_write, cancelled.
Result<WriteReport> write_obj(const Model& model, const std::filesystem::path& path, Task task = {});

}  // namespace lodestone::io
