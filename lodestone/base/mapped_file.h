// A file's bytes as memory, brought in and dropped again by the system as it likes.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>

#include "lodestone/base/result.h"

namespace lodestone {

struct MappedFile {
  std::span<const std::byte> bytes;
  std::shared_ptr<const void> mapping;  ///< keeps them, also when the file's name is gone
};

/// Maps a regular file for reading. It must not be cut off by others meanwhile. Errors: cannot_read.
Result<MappedFile> map_file(const std::filesystem::path& path);

}  // namespace lodestone
