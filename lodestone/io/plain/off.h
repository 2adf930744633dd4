// OFF: vertices and polygons as text, with colours, normals and texture coordinates of vertices.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/model.h"

namespace lodestone::io {

/// Reads ASCII OFF with any of the prefixes ST, C and N. Streams: "NORMAL", "COLOR_0" (whole numbers with one above 1
/// are 0 to 255, as are others where one is above 16; else they are 0 to 1), "TEXCOORD_0". A plain OFF whose vertices
/// have three or four numbers more has colours too. Comments, joined words ("OFF8 6 12") and any spacing are
/// understood. Colours of faces are left out with a warning. Errors: cannot_read, bad_format (with the line),
/// unsupported (binary, four or n dimensions), empty, cancelled. Time O(size); memory at most 2.5 times the result.
Result<Model> read_off(const std::filesystem::path& path, Task task = {});

/// The same from memory. `name` stands for the file in messages.
Result<Model> read_off(std::span<const std::byte> bytes, std::string_view name, Task task = {});

}  // namespace lodestone::io
