#include "app/output/setting_names.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace lodestone::app {

namespace {

// Settings whose option has another name.
constexpr std::array<std::pair<std::string_view, std::string_view>, 5> kOtherNames{{
    {"build_voxel_ladder()", "--method voxel"},
    {"compression", "--compress"},
    {"join_length", "--join"},
    {"raw", "--raw"},
    {"weld_tolerance", "--weld"},
}};

// Settings whose option has the same name, but for - in place of _.
constexpr std::array<std::string_view, 17> kSameNames{
    "close",         "error",        "fill",      "force",  "iso",        "keep_border",
    "keep_thin",     "labels",       "prune",     "series", "resolution", "supersample",
    "then_collapse", "texture_size", "triangles", "smooth", "median"};

std::string option_of(std::string_view setting) {
  for (const auto& [name, option] : kOtherNames) {
    if (setting == name) return std::string(option);
  }
  if (std::find(kSameNames.begin(), kSameNames.end(), setting) == kSameNames.end()) return {};
  std::string option = "--" + std::string(setting);
  std::replace(option.begin(), option.end(), '_', '-');
  return option;
}

}  // namespace

std::string with_options(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const std::size_t begin = text.find('`');
    const std::size_t end = begin == std::string_view::npos ? begin : text.find('`', begin + 1);
    if (end == std::string_view::npos) break;
    const std::string option = option_of(text.substr(begin + 1, end - begin - 1));
    if (option.empty()) {
      out += text.substr(0, begin + 1);
      text.remove_prefix(begin + 1);
      continue;
    }
    out += text.substr(0, begin);
    out += option;
    text.remove_prefix(end + 1);
  }
  return out += text;
}

std::vector<std::string> with_options(std::vector<std::string> texts) {
  for (std::string& text : texts) text = with_options(text);
  return texts;
}

Error with_options(Error error) {
  error.what = with_options(error.what);
  error.remedy = with_options(error.remedy);
  return error;
}

}  // namespace lodestone::app
