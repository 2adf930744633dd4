// Files that a model names: found where they are today, not only where they were.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

namespace lodestone::io {

/// The file that `name` means, under `root`, for a file in `root / from` that names it ("textures\\a.png" too). Where
/// it is not there, `name` without its first folders is tried, as models often carry the paths of the machine that they
/// come from ("C:\\art\\tex\\a.png": "art/tex/a.png", "tex/a.png", "a.png"), each beside the naming file, then in
/// `root`; then all of these with letters of either case. Nothing outside `root` is looked at. Nothing: not found.
std::optional<std::filesystem::path> find_near(const std::filesystem::path& root, const std::filesystem::path& from,
                                               std::string_view name);

}  // namespace lodestone::io
