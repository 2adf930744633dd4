#include "lodestone/io/mtl.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "lodestone/base/text.h"
#include "lodestone/io/image_file_detail.h"
#include "lodestone/io/text_reader_detail.h"

namespace lodestone::io {

namespace {

// Up to `count` numbers off the front of `rest`; returns how many there were.
std::size_t take_numbers(std::string_view& rest, float* into, std::size_t count) {
  std::size_t taken = 0;
  while (taken < count) {
    std::string_view ahead = rest;
    float value = 0;
    if (!parse_number(next_word(ahead), value)) break;
    into[taken++] = value;
    rest = ahead;
  }
  return taken;
}

float share(float value) { return value >= 0 ? std::min(value, 1.0F) : 0.0F; }

// The kinds of lines that are not understood, each once, in order of first use.
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

// The file name of a map line, which may hold blanks, behind its options.
std::string_view map_name(std::string_view key, std::string_view rest, LeftOut& left_out) {
  while (true) {
    std::string_view ahead = trimmed(rest);
    if (!ahead.starts_with('-')) return ahead;
    const std::string_view option = next_word(ahead);
    float ignored[3];
    if (option == "-s" || option == "-o" || option == "-t") {
      take_numbers(ahead, ignored, 3);
    } else if (option == "-mm") {
      take_numbers(ahead, ignored, 2);
    } else if (option == "-bm" || option == "-boost" || option == "-texres") {
      take_numbers(ahead, ignored, 1);
    } else if (option == "-blendu" || option == "-blendv" || option == "-cc" || option == "-clamp" ||
               option == "-imfchan" || option == "-type") {
      next_word(ahead);
    } else {
      return trimmed(rest);  // a name that begins with '-'
    }
    left_out.add(fmt::format("{} {}", key, option));
    rest = ahead;
  }
}

class MtlParser {
 public:
  MtlParser(const std::filesystem::path& folder, std::vector<Material>& materials, std::vector<std::string>& left_out,
            std::vector<std::string>& warnings)
      : folder_(folder), materials_(materials), left_out_(left_out), warnings_(warnings) {}

  void line(std::string_view rest) {
    const std::string_view word = next_word(rest);
    if (word.empty() || word.front() == '#') return;
    const std::string key = lower_case(word);
    if (key == "newmtl") {
      finish();
      Material material;
      material.name = trimmed(rest);
      materials_.push_back(std::move(material));
      open_ = true;
      return;
    }
    if (!open_) return;
    Material& material = materials_.back();
    float v[3] = {0, 0, 0};
    if (key == "kd") {
      const std::size_t n = take_numbers(rest, v, 3);
      if (n == 1) v[1] = v[2] = v[0];
      if (n > 0) std::transform(v, v + 3, material.base_color.begin(), share);
    } else if (key == "d") {
      if (take_numbers(rest, v, 1) == 1) material.base_color[3] = share(v[0]);
    } else if (key == "tr") {
      if (take_numbers(rest, v, 1) == 1) material.base_color[3] = share(1 - v[0]);
    } else if (key == "pr") {
      if (take_numbers(rest, v, 1) == 1) material.roughness = share(v[0]);
    } else if (key == "pm") {
      if (take_numbers(rest, v, 1) == 1) material.metallic = share(v[0]);
    } else if (key == "map_kd") {
      material.base_color_texture = image(map_name(word, rest, left_out_));
    } else if (key == "norm") {
      material.normal_texture = image(map_name(word, rest, left_out_));
    } else {
      left_out_.add(word.substr(0, 40));
    }
  }

  void finish() {
    if (!open_) return;
    Material& material = materials_.back();
    std::array<float, 4>& color = material.base_color;
    if (material.base_color_texture && color[0] == 0 && color[1] == 0 && color[2] == 0) color = {1, 1, 1, color[3]};
  }

 private:
  std::shared_ptr<const Image> image(std::string_view name) {
    if (name.empty()) return nullptr;
    const auto [at, is_new] = images_.try_emplace(std::string(name));
    if (is_new) at->second = load_image_near(folder_, name, warnings_);
    return at->second;
  }

  const std::filesystem::path& folder_;
  std::vector<Material>& materials_;
  LeftOut left_out_;
  std::vector<std::string>& warnings_;
  std::map<std::string, std::shared_ptr<const Image>> images_;
  bool open_ = false;
};

}  // namespace

void read_mtl(std::string_view text, const std::filesystem::path& folder, std::vector<Material>& materials,
              std::vector<std::string>& left_out, std::vector<std::string>& warnings) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  MtlParser parser(folder, materials, left_out, warnings);
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    parser.line(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  parser.finish();
}

std::string mtl_text(std::span<const Material> materials, std::span<const std::string> names,
                     std::span<const MtlTextures> textures) {
  std::string out = "# made by Lodestone\n";
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const Material& m = materials[i];
    const std::array<float, 4>& color = m.base_color;
    out += fmt::format("newmtl {}\nKd {} {} {}\nd {}\n", names[i], color[0], color[1], color[2], color[3]);
    out += fmt::format("Pr {}\nPm {}\n", m.roughness, m.metallic);
    if (!textures[i].base_color.empty()) out += fmt::format("map_Kd {}\n", textures[i].base_color);
    if (!textures[i].normal.empty()) out += fmt::format("norm {}\n", textures[i].normal);
  }
  return out;
}

}  // namespace lodestone::io
