// PLY: ASCII and binary of both byte orders, any elements and properties in any order.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/model.h"

namespace lodestone::io {

/// Reads one mesh from `element vertex` and `element face` (polygons are cut) or `element tristrips` (restarts at -1).
///
/// Vertex properties become streams. Those that belong together are one stream, named by its properties with blanks
/// between: "nx ny nz", "red green blue alpha", "s t"; any other property is a stream of its own under its own name and
/// type. Integers named like ids, labels or classes are categorical. Texture coordinates of faces (`texcoord`) become
/// wedges in a stream "s t" (origin at the bottom left, see Model::uv_origin_top). Positions in doubles far from the
/// origin set Mesh::offset. `comment TextureFile` gives a material. Left out, with a warning: other properties of
/// faces, lists of vertices, other elements, faces with less than 3 corners. Errors: cannot_read, bad_format (with line
/// or byte), unsupported (more than 2^32 - 2 vertices), empty, cancelled. Time O(size); memory at most 2.5 times the
/// result.
Result<Model> read_ply(const std::filesystem::path& path, Task task = {});

/// The same from memory. `name` stands for the file in messages; textures are not looked for.
Result<Model> read_ply(std::span<const std::byte> bytes, std::string_view name, Task task = {});

}  // namespace lodestone::io
