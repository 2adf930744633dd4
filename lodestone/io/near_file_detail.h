// Files that a model names: found where they are today, not only where they were.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace lodestone::io {

/// Looks for files under a model's folder. Each folder is listed once, and only where a name is not there as spelt.
class NearFiles {
 public:
  explicit NearFiles(std::filesystem::path root) : root_(std::move(root)) {}

  /// The file that `name` means for a file in `root / from` that names it ("textures\\a.png" too). Where it is not
  /// there, `name` without its first folders is tried, as models often carry the paths of the machine that they come
  /// from ("C:\\art\\tex\\a.png": "art/tex/a.png", "tex/a.png", "a.png"), each beside the naming file, then in the
  /// root; then all of these with letters of either case, of names that differ in case alone the first in the alphabet.
  /// Nothing outside the root is looked at. Nothing: not found.
  std::optional<std::filesystem::path> find(const std::filesystem::path& from, std::string_view name);

  const std::filesystem::path& root() const { return root_; }

 private:
  std::optional<std::filesystem::path> find_in_any_case(const std::filesystem::path& wanted);
  // The names in a folder by their small letters.
  const std::map<std::string, std::string>& names_in(const std::filesystem::path& folder);

  std::filesystem::path root_;
  std::map<std::filesystem::path, std::map<std::string, std::string>> listed_;
};

}  // namespace lodestone::io
