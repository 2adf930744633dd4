#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lodestone/io/plain/mtl_detail.h"
#include "lodestone/io/plain/mtl_images_detail.h"
#include "lodestone/io/plain/mtl_words_detail.h"
#include "lodestone/io/read_detail.h"

namespace lodestone::io {

namespace {

float share(float value) { return value >= 0 ? std::min(value, 1.0F) : 0.0F; }

// Options of the kept line of a map that a field holds, too: the line stands for both. Nothing without one.
const MtlLine* line_of(const Material& material, std::string_view key, const Image* texture) {
  for (const MtlLine& line : material.mtl_lines) {
    if (line.texture && line.texture.get() == texture && key_of(line.text) == key) return &line;
  }
  return nullptr;
}

class MtlParser {
 public:
  MtlParser(MtlImages& images, const std::filesystem::path& from, std::vector<Material>& materials,
            std::vector<std::string>& warnings)
      : images_(images), from_(from), materials_(materials), warnings_(warnings) {}

  void line(std::string_view whole) {
    whole = trimmed(whole);
    std::string_view rest = whole;
    const std::string_view word = next_word(rest);
    if (word.empty() || word.front() == '#') return;
    const std::string key = lower_case(word);
    if (key == "newmtl") {
      finish();
      Material material;
      material.name = trimmed(rest);
      materials_.push_back(std::move(material));
      open_ = true;
      has_roughness_ = false;
      return;
    }
    if (!open_) return;
    if (is_map_key(key)) {
      take_map(whole, key, rest);
    } else if (!take_value(key, rest)) {
      keep(whole);
    }
  }

  void finish() {
    if (!open_) return;
    Material& material = materials_.back();
    std::array<float, 4>& color = material.base_color;
    const std::shared_ptr<const Image>& texture = material.base_color_texture;
    if (texture && color[0] == 0 && color[1] == 0 && color[2] == 0) color = {1, 1, 1, color[3]};
    if (!has_roughness_) material.roughness = roughness_of_highlight(material).value_or(material.roughness);
    if (line_of(material, "map_d", texture.get()) != nullptr && images_.is_transparent(texture)) material.blend = true;
  }

  // Call it after the last line.
  void tell() {
    if (left_out_ == 0) return;
    warnings_.push_back(fmt::format(
        "{} left out, as a material keeps {} at most",
        counted(left_out_, "line of the material library was", "lines of the material library were"), kMostLines));
  }

 private:
  // False for a line that no field holds.
  bool take_value(std::string_view key, std::string_view rest) {
    Material& material = materials_.back();
    float v[3] = {0, 0, 0};
    if (key == "kd") {
      const std::size_t n = take_numbers(rest, v, 3);
      if (n == 1) v[1] = v[2] = v[0];
      if (n > 0) std::transform(v, v + 3, material.base_color.begin(), share);
      return n > 0;
    }
    if (key != "d" && key != "tr" && key != "pr" && key != "pm") return false;
    if (take_numbers(rest, v, 1) == 0) return false;
    if (key == "d") material.base_color[3] = share(v[0]);
    if (key == "tr") material.base_color[3] = share(1 - v[0]);
    if (key == "pm") material.metallic = share(v[0]);
    if (key == "pr") {
      material.roughness = share(v[0]);
      has_roughness_ = true;
    }
    return true;
  }

  // The file name, which may hold blanks, stands behind the options.
  void take_map(std::string_view whole, std::string_view key, std::string_view rest) {
    Material& material = materials_.back();
    bool has_options = false;
    while (!take_option(rest).empty()) has_options = true;
    const std::string_view name = trimmed(rest);
    const std::shared_ptr<const Image> texture = images_.load(from_, name, warnings_);
    if (key == "map_kd") material.base_color_texture = texture;
    if (key == "norm") material.normal_texture = texture;
    const bool held = (key == "map_kd" || key == "norm") && !has_options;
    if (texture == nullptr || texture->encoded.empty()) {
      keep(whole);
    } else if (!held) {
      keep(trimmed(whole.substr(0, static_cast<std::size_t>(name.data() - whole.data()))), texture);
    }
  }

  // Not what would spoil the lines around it.
  void keep(std::string_view line, std::shared_ptr<const Image> texture = nullptr) {
    const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20 && c != '\t'; };
    if (std::any_of(line.begin(), line.end(), is_control)) return;
    std::vector<MtlLine>& lines = materials_.back().mtl_lines;
    if (lines.size() == kMostLines) {
      ++left_out_;
    } else {
      lines.push_back({std::string(line), std::move(texture)});
    }
  }

  static constexpr std::size_t kMostLines = 256;  // kept of a material: a damaged file may hold any number
  MtlImages& images_;
  const std::filesystem::path& from_;
  std::vector<Material>& materials_;
  std::vector<std::string>& warnings_;
  std::size_t left_out_ = 0;
  bool open_ = false, has_roughness_ = false;
};

void append_map(std::string& out, const Material& material, std::string_view key, std::string_view written,
                const Image* texture, std::span<const TextureFile> textures) {
  const std::string_view name = texture_name(textures, texture);
  if (name.empty()) return;
  const MtlLine* line = line_of(material, key, texture);
  out += fmt::format("{} {}\n", line != nullptr ? std::string_view(line->text) : written, name);
}

void append_kept(std::string& out, const Material& material, std::span<const TextureFile> textures) {
  for (const MtlLine& line : material.mtl_lines) {
    const std::string key = key_of(line.text);
    const std::shared_ptr<const Image>* held = key == "map_kd" ? &material.base_color_texture
                                               : key == "norm" ? &material.normal_texture
                                                               : nullptr;
    // One of these is written already, or has been replaced.
    if (held != nullptr && *held != nullptr && !texture_name(textures, held->get()).empty()) continue;
    if (line.texture == nullptr) {
      out += line.text + '\n';
    } else if (const std::string_view name = texture_name(textures, line.texture.get()); !name.empty()) {
      out += fmt::format("{} {}\n", line.text, name);
    }
  }
}

}  // namespace

std::optional<float> roughness_of_highlight(const Material& material) {
  std::optional<float> exponent;
  bool shines = true;
  for (const MtlLine& line : material.mtl_lines) {
    std::string_view rest = line.text;
    const std::string key = lower_case(next_word(rest));
    float v[3] = {0, 0, 0};
    const std::size_t n = key == "ns" || key == "ks" || key == "illum" ? take_numbers(rest, v, 3) : 0;
    if (n == 0) continue;
    if (key == "ns") exponent = std::max(v[0], 0.0F);
    if (key == "ks") shines = shines && (v[0] > 0 || v[1] > 0 || v[2] > 0);
    if (key == "illum") shines = shines && v[0] != 0 && v[0] != 1;
  }
  if (!exponent || !std::isfinite(*exponent)) return std::nullopt;
  return shines ? std::sqrt(std::sqrt(2 / (*exponent + 2))) : 1.0F;
}

void read_mtl(std::string_view text, MtlImages& images, const std::filesystem::path& from,
              std::vector<Material>& materials, std::vector<std::string>& warnings) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  MtlParser parser(images, from, materials, warnings);
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    parser.line(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  parser.finish();
  parser.tell();
}

std::string mtl_text(std::span<const Material> materials, std::span<const std::string> names,
                     std::span<const TextureFile> textures) {
  std::string out = "# made by Lodestone\n";
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const Material& m = materials[i];
    const std::array<float, 4>& color = m.base_color;
    out += fmt::format("newmtl {}\nKd {} {} {}\nd {}\n", names[i], color[0], color[1], color[2], color[3]);
    if (m.metallic != 0 || m.roughness != roughness_of_highlight(m)) {
      out += fmt::format("Pr {}\nPm {}\n", m.roughness, m.metallic);
    }
    append_map(out, m, "map_kd", "map_Kd", m.base_color_texture.get(), textures);
    append_map(out, m, "norm", "norm", m.normal_texture.get(), textures);
    append_kept(out, m, textures);
    if ((m.blend || m.alpha_cutoff > 0) && line_of(m, "map_d", m.base_color_texture.get()) == nullptr) {
      append_map(out, m, "map_d", "map_d", m.base_color_texture.get(), textures);
    }
  }
  return out;
}

}  // namespace lodestone::io
