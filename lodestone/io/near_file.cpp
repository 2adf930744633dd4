#include "lodestone/io/near_file_detail.h"

#include <algorithm>
#include <string>
#include <vector>

#include "lodestone/base/text.h"

namespace lodestone::io {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMostFolders = 16;  // of a name's last ones: a damaged file may hold any number

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

// Relative to the root, likeliest first.
std::vector<fs::path> candidates(const fs::path& from, std::string_view name) {
  std::string spelt(name);
  std::replace(spelt.begin(), spelt.end(), '\\', '/');
  bool absolute = spelt.starts_with('/');
  if (spelt.size() > 1 && spelt[1] == ':') {
    absolute = true;
    spelt.erase(0, 2);
  }
  std::vector<std::string> rest;  // the name, then without its first folder, …
  if (!absolute) rest.push_back(spelt);
  std::vector<std::string> shorter;
  for (std::size_t slash = spelt.rfind('/'); slash != std::string::npos && shorter.size() < kMostFolders;
       slash = slash == 0 ? std::string::npos : spelt.rfind('/', slash - 1)) {
    shorter.push_back(spelt.substr(slash + 1));
  }
  rest.insert(rest.end(), shorter.rbegin(), shorter.rend());
  std::vector<fs::path> out;
  for (const std::string& one : rest) {
    for (const fs::path& folder : {from, fs::path()}) {
      const fs::path path = (folder / one).lexically_normal();
      if (one.empty() || path.empty() || path.is_absolute() || *path.begin() == ".." || path == ".") continue;
      if (std::find(out.begin(), out.end(), path) == out.end()) out.push_back(path);
    }
  }
  return out;
}

}  // namespace

const std::map<std::string, std::string>& NearFiles::names_in(const fs::path& folder) {
  const auto [at, is_new] = listed_.try_emplace(folder);
  if (!is_new) return at->second;
  std::error_code error;
  fs::directory_iterator entry(folder, error), end;
  for (; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    std::string& kept = at->second[lower_case(name)];
    if (kept.empty() || name < kept) kept = name;
  }
  return at->second;
}

std::optional<fs::path> NearFiles::find_in_any_case(const fs::path& wanted) {
  fs::path at = root_.empty() ? fs::path(".") : root_;
  for (const fs::path& part : wanted) {
    std::error_code error;
    if (!fs::exists(at / part, error)) {
      const std::map<std::string, std::string>& names = names_in(at);
      const auto found = names.find(lower_case(part.string()));
      if (found == names.end()) return std::nullopt;
      at /= found->second;
    } else {
      at /= part;
    }
  }
  return is_file(at) ? std::optional(at) : std::nullopt;
}

std::optional<fs::path> NearFiles::find(const fs::path& from, std::string_view name) {
  if (name.find('\0') != std::string_view::npos) return std::nullopt;
  const std::vector<fs::path> paths = candidates(from, name);
  for (const fs::path& path : paths) {
    if (is_file(root_ / path)) return root_ / path;
  }
  for (const fs::path& path : paths) {
    if (std::optional<fs::path> found = find_in_any_case(path)) return found;
  }
  return std::nullopt;
}

}  // namespace lodestone::io
