// How many levels a glTF holds.
#pragma once

#include <cstdint>
#include <filesystem>

namespace lodestone::io {

/// Levels of a ladder (MSFT_lod) in a glTF or GLB, with level 0; 1 for anything else, and for files that can't be read.
std::uint64_t levels_in_file(const std::filesystem::path& path);

}  // namespace lodestone::io
