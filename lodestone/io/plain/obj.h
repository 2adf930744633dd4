// OBJ: polygons with UV and normals by corner, groups, materials.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/model.h"

namespace lodestone::io {

/// Reads the faces of an OBJ as one mesh. Each triple of material (`usemtl`), part (`o`) and name (the last `g` or `o`)
/// is a face group, in order of first use. UV and normals of corners make wedges, in streams TEXCOORD_0 and NORMAL; `v
/// x y z r g b` (or `r g b a`) gives COLOR_0: whole numbers with one above 1 are 0 to 255, as are others where one is
/// above 16; else they are 0 to 1. Texture coordinates stay as they are: their origin is at the bottom left
/// (Model::uv_origin_top is false). Coordinates far from the origin set Mesh::offset. Polygons are cut (see polygon.h);
/// negative indices, `\` at the end of a line and faces before their vertices are understood. Materials come from
/// `mtllib` with all their lines (Material::mtl_lines); a missing library or image is a warning, and nothing outside
/// the OBJ's folder is opened. Points, lines and curved surfaces are left out with a warning. Errors: cannot_read,
/// bad_format (with the line), unsupported (UTF-16), empty, cancelled. Time O(size); memory at most 2.5 times the
/// result.
Result<Model> read_obj(const std::filesystem::path& path, Task task = {});

/// The same from memory. `name` stands for the file in messages; material libraries are not looked for.
Result<Model> read_obj(std::span<const std::byte> bytes, std::string_view name, Task task = {});

}  // namespace lodestone::io
