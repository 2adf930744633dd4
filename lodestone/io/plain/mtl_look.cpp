// What glTF holds of the lines of an MTL.
#include <fmt/format.h>

#include <algorithm>

#include "lodestone/io/images/decode.h"
#include "lodestone/io/plain/mtl_detail.h"
#include "lodestone/io/plain/mtl_words_detail.h"

namespace lodestone::io {

namespace {

// The kinds of lines that are not held, each once, in order of first use.
class LeftOut {
 public:
  explicit LeftOut(std::vector<std::string>& kinds) : kinds_(kinds) {}

  void add(std::string_view kind) {
    if (kinds_.size() > kMost || !std::all_of(kind.begin(), kind.end(), is_printable)) return;
    const std::string lower = lower_case(kind);
    if (std::any_of(kinds_.begin(), kinds_.end(), [&](const std::string& k) { return lower_case(k) == lower; })) return;
    kinds_.push_back(kinds_.size() == kMost ? "others" : std::string(kind));
  }

 private:
  static constexpr std::size_t kMost = 12;  // a damaged file may hold any number
  static bool is_printable(char c) { return c >= 0x20 && c < 0x7f; }
  std::vector<std::string>& kinds_;
};

// Exporters name normal maps as bump maps, too. Those are bluish, and nearly all their pixels unit vectors; height maps
// are grey.
bool is_normal_map(const Image& image) {
  const Result<Pixels> pixels = decode_image(image);
  if (!pixels || pixels->width == 0 || pixels->height == 0) return false;
  constexpr std::uint32_t kAcross = 64;
  std::uint32_t seen = 0, unit = 0;
  std::int64_t blueness = 0;
  const std::uint32_t step_x = pixels->width / kAcross + 1, step_y = pixels->height / kAcross + 1;
  for (std::uint32_t y = step_y / 2; y < pixels->height; y += step_y) {
    for (std::uint32_t x = step_x / 2; x < pixels->width; x += step_x) {
      const auto [r, g, b, a] = pixels->at(x, y);
      const double nx = r / 127.5 - 1, ny = g / 127.5 - 1, nz = b / 127.5 - 1;
      const double length_sq = nx * nx + ny * ny + nz * nz;
      ++seen;
      unit += nz > -0.1 && length_sq > 0.65 && length_sq < 1.35 ? 1 : 0;
      blueness += int{b} - std::max(int{r}, int{g});
    }
  }
  return seen > 0 && unit >= seen / 10 * 9 && blueness > 24 * std::int64_t{seen};
}

class Look {
 public:
  Look(const Material& material, std::vector<std::string>& left_out)
      : material_(material), highlight_(roughness_of_highlight(material)), left_out_(left_out) {}

  MtlLook look() {
    for (const MtlLine& line : material_.mtl_lines) take(line);
    if (!has_emission_ && look_.emissive_texture != nullptr) look_.emissive = {1, 1, 1};
    return look_;
  }

 private:
  void take(const MtlLine& line) {
    std::string_view rest = line.text;
    const std::string_view word = next_word(rest);
    const std::string key = lower_case(word);
    float v[3] = {0, 0, 0};
    if (key == "ke") {
      const std::size_t n = take_numbers(rest, v, 3);
      if (n == 1) v[1] = v[2] = v[0];
      for (std::size_t k = 0; k < 3; ++k) look_.emissive[k] = v[k] > 0 ? std::min(v[k], 1.0F) : 0.0F;
      has_emission_ = n > 0;
    } else if (key == "ns" && highlight_ == material_.roughness) {
      // is the roughness
    } else if (is_map_key(key)) {
      take_map(line, word, key, rest);
    } else {
      left_out_.add(word.substr(0, 40));
    }
  }

  void take_map(const MtlLine& line, std::string_view word, std::string_view key, std::string_view rest) {
    if (line.texture == nullptr) return;  // was told when it was not found
    const bool is_bump = is_bump_key(key) && material_.normal_texture == nullptr && look_.normal_texture == nullptr &&
                         is_normal_map(*line.texture);
    if (is_bump) look_.normal_texture = line.texture.get();
    if (key == "map_ke") look_.emissive_texture = line.texture.get();
    const bool is_alpha = key == "map_d" && line.texture == material_.base_color_texture && material_.blend;
    if (!is_bump && !is_alpha && key != "map_ke" && key != "map_kd" && key != "norm") {
      left_out_.add(word.substr(0, 40));
      return;
    }
    for (std::string_view option = take_option(rest); !option.empty(); option = take_option(rest)) {
      std::string_view value = option;
      const std::string_view name = next_word(value);
      float scale = 0;
      if (name == "-bm" && (is_bump || key == "norm") && take_numbers(value, &scale, 1) == 1) {
        look_.normal_scale = scale;
      } else if (!(name == "-imfchan" && is_alpha)) {
        left_out_.add(fmt::format("{} {}", word, name));
      }
    }
  }

  const Material& material_;
  const std::optional<float> highlight_;
  LeftOut left_out_;
  MtlLook look_;
  bool has_emission_ = false;
};

}  // namespace

MtlLook look_of(const Material& material, std::vector<std::string>& left_out) {
  return Look(material, left_out).look();
}

}  // namespace lodestone::io
