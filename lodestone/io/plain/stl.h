// STL: triangle soup, ASCII or binary.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/model.h"

namespace lodestone::io {

/// Reads an STL; corners at equal positions become one vertex. ASCII or binary is told by size and content, not by the
/// word "solid". Stored normals are ignored, as the corners' order says the same. Several ASCII solids are face groups.
/// Bytes behind the last triangle and colours in a binary file's attribute bytes are left out with a warning.
/// Errors: cannot_read, bad_format (with line or byte), empty, cancelled. Time O(size); memory at most 2.5 times the
/// result.
Result<Model> read_stl(const std::filesystem::path& path, Task task = {});

/// The same from memory. `name` stands for the file in messages.
Result<Model> read_stl(std::span<const std::byte> bytes, std::string_view name, Task task = {});

}  // namespace lodestone::io
