#include <fmt/format.h>

#include <algorithm>

#include "lodestone/io/images/decode.h"
#include "lodestone/io/images/file_detail.h"
#include "lodestone/io/plain/mtl_images_detail.h"
#include "lodestone/io/read_detail.h"

namespace lodestone::io {

std::shared_ptr<const Image> MtlImages::load(const std::filesystem::path& from, std::string_view name,
                                             std::vector<std::string>& warnings) {
  constexpr std::size_t kMostNames = 4096;
  if (name.empty()) return nullptr;
  const std::string key = fmt::format("{}\n{}", from.string(), name);
  const auto known = by_name_.find(key);
  if (known != by_name_.end()) return known->second;
  if (by_name_.size() == kMostNames) {
    ++left_out_;
    return nullptr;
  }
  const std::optional<std::filesystem::path> path = files_.find(from, name);
  return by_name_[key] = path ? load_file(*path, name, warnings) : load_image(path, name, warnings);
}

std::shared_ptr<const Image> MtlImages::load_file(const std::filesystem::path& path, std::string_view name,
                                                  std::vector<std::string>& warnings) {
  std::shared_ptr<const Image>& kept = by_path_[path];
  if (kept != nullptr) return kept;
  kept = load_image(path, name, warnings);
  const auto [first, last] = by_short_name_.equal_range(kept->name);
  const auto same =
      std::find_if(first, last, [&](const auto& other) { return other.second->encoded == kept->encoded; });
  if (same != last) return kept = same->second;  // the same file in two folders
  by_short_name_.emplace(kept->name, kept);
  return kept;
}

bool MtlImages::is_transparent(const std::shared_ptr<const Image>& image) {
  const auto [at, is_new] = transparent_.try_emplace(image.get(), false);
  if (!is_new) return at->second;
  const Result<Pixels> pixels = decode_image(*image);
  if (!pixels) return false;
  for (std::size_t i = 3; i < pixels->rgba.size() && !at->second; i += 4) at->second = pixels->rgba[i] != 255;
  return at->second;
}

void MtlImages::tell(std::vector<std::string>& warnings) const {
  if (left_out_ == 0) return;
  warnings.push_back(
      fmt::format("{} name more than 4,096 textures: those beyond were not looked for",
                  counted(left_out_, "line of the material libraries would", "lines of the material libraries would")));
}

}  // namespace lodestone::io
