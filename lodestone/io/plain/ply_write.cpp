#include "lodestone/io/plain/ply_write.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>

#include "lodestone/base/file.h"
#include "lodestone/core/flatten.h"
#include "lodestone/io/images/file_detail.h"
#include "lodestone/io/read_detail.h"
#include "lodestone/io/write_detail.h"

namespace lodestone::io {

namespace {

const char* type_name(ComponentType type) {
  switch (type) {
    case ComponentType::int8:
      return "char";
    case ComponentType::uint8:
      return "uchar";
    case ComponentType::int16:
      return "short";
    case ComponentType::uint16:
      return "ushort";
    case ComponentType::int32:
      return "int";
    case ComponentType::uint32:
      return "uint";
    case ComponentType::float32:
      return "float";
    case ComponentType::float64:
      return "double";
  }
  return "";
}

std::vector<std::string> split(std::string_view text) {
  std::vector<std::string> words;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    if (end > at) words.emplace_back(text.substr(at, end - at));
    at = end + 1;
  }
  return words;
}

// One stream as properties.
struct Columns {
  const AttributeStream* stream;
  std::vector<std::string> names;  // one a component
  ComponentType type;
  bool flip_v = false;
};

// The names that the PLY had, else the usual ones for the meaning, else numbered ones.
std::vector<std::string> property_names(const AttributeStream& stream) {
  const std::size_t n = stream.components;
  std::vector<std::string> words = split(stream.name);
  if (words.size() == n &&
      (n > 1 || stream.semantic == Semantic::generic || stream.semantic == Semantic::categorical)) {
    return words;
  }
  if (stream.semantic == Semantic::normal && n == 3) return {"nx", "ny", "nz"};
  if (stream.semantic == Semantic::uv && n == 2) {
    const std::string set = stream.set == 0 ? "" : std::to_string(stream.set);
    return {"s" + set, "t" + set};
  }
  if (stream.semantic == Semantic::color && stream.set == 0 && n >= 3) {
    words = {"red", "green", "blue", "alpha"};
    words.resize(n);
    return words;
  }
  std::string base = stream.name;
  std::replace_if(
      base.begin(), base.end(), [](char c) { return c == ' ' || static_cast<unsigned char>(c) < 0x21; }, '_');
  if (n == 1) return {base};
  words.clear();
  for (std::size_t k = 0; k < n; ++k) words.push_back(fmt::format("{}_{}", base, k));
  return words;
}

std::vector<Columns> plan_columns(const Mesh& mesh, bool flip_v) {
  std::vector<Columns> out;
  for (const AttributeStream& stream : mesh.attributes) {
    Columns c{&stream, property_names(stream), stream.type, flip_v && stream.semantic == Semantic::uv};
    const bool bits = std::holds_alternative<std::vector<std::uint32_t>>(stream.values);
    if (!bits && stream.normalized && stream.semantic != Semantic::color) c.type = ComponentType::float32;
    out.push_back(std::move(c));
  }
  return out;
}

template <class T>
void append(std::string& out, T value) {
  out.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

void append_integer(std::string& out, double value, ComponentType type) {
  const double most = largest_of(type);
  const bool is_signed = type == ComponentType::int8 || type == ComponentType::int16;
  const double whole =
      std::clamp(value < 0 ? std::ceil(value - 0.5) : std::floor(value + 0.5), is_signed ? -most - 1 : 0.0, most);
  switch (type) {
    case ComponentType::int8:
      return append(out, static_cast<std::int8_t>(whole));
    case ComponentType::uint8:
      return append(out, static_cast<std::uint8_t>(whole));
    case ComponentType::int16:
      return append(out, static_cast<std::int16_t>(whole));
    default:
      return append(out, static_cast<std::uint16_t>(whole));
  }
}

void append_value(std::string& out, const Columns& c, std::size_t at, std::size_t component) {
  const AttributeStream& s = *c.stream;
  if (const auto* bits = std::get_if<std::vector<std::uint32_t>>(&s.values)) {
    const std::uint32_t v = (*bits)[at];
    switch (size_of(c.type)) {
      case 1:
        return append(out, static_cast<std::uint8_t>(v));
      case 2:
        return append(out, static_cast<std::uint16_t>(v));
      default:
        return append(out, v);
    }
  }
  double v = 0;
  if (const auto* doubles = std::get_if<std::vector<double>>(&s.values)) v = (*doubles)[at];
  if (const auto* floats = std::get_if<std::vector<float>>(&s.values)) v = (*floats)[at];
  if (c.flip_v && component == 1) v = 1 - v;
  if (c.type == ComponentType::float64) return append(out, v);
  if (c.type == ComponentType::float32) return append(out, static_cast<float>(v));
  append_integer(out, s.normalized ? v * largest_of(c.type) : v, c.type);
}

// The one texture that a PLY can name, for all its faces; nothing, with a warning, where that doesn't fit.
std::optional<TextureFile> find_texture(const Model& model, const Mesh& mesh, const std::filesystem::path& path,
                                        std::vector<std::string>& warnings) {
  std::vector<Material> drawn;
  for (const FaceGroup& g : mesh.groups) {
    if (g.material < model.materials.size()) drawn.push_back(model.materials[g.material]);
  }
  if (std::any_of(drawn.begin(), drawn.end(), [](const Material& m) { return m.normal_texture != nullptr; })) {
    warnings.push_back("PLY does not hold normal maps: left out");
  }
  std::vector<TextureFile> textures = texture_files(drawn, path);
  if (textures.empty()) return std::nullopt;
  if (textures.size() > 1) {
    warnings.push_back(fmt::format("PLY holds one texture: all {} were left out", textures.size()));
    return std::nullopt;
  }
  const AttributeStream* uv = find_stream(mesh, Semantic::uv);
  if (uv == nullptr || uv->components != 2) {
    warnings.push_back(fmt::format("the texture '{}' was left out: there are no UVs", textures[0].name));
    return std::nullopt;
  }
  const auto bare =
      static_cast<std::uint64_t>(std::count_if(mesh.groups.begin(), mesh.groups.end(), [&](const auto& g) {
        if (g.material >= model.materials.size()) return true;
        return texture_name(textures, model.materials[g.material].base_color_texture.get()).empty();
      }));
  if (bare > 0) {
    warnings.push_back(fmt::format("PLY has one texture for all faces: {} without '{}' got it, too",
                                   counted(bare, "group", "groups"), textures[0].name));
  }
  return std::move(textures[0]);
}

std::string header_of(const Mesh& mesh, const std::vector<Columns>& columns, std::string_view texture) {
  std::string out = "ply\nformat binary_little_endian 1.0\ncomment made by Lodestone\n";
  if (!texture.empty()) out += fmt::format("comment TextureFile {}\n", texture);
  out += fmt::format("element vertex {}\n", mesh.wedge_count());
  const char* position = mesh.offset == Vec3d{} ? "float" : "double";
  for (const char* axis : {"x", "y", "z"}) out += fmt::format("property {} {}\n", position, axis);
  for (const Columns& c : columns) {
    for (const std::string& name : c.names) out += fmt::format("property {} {}\n", type_name(c.type), name);
  }
  out += fmt::format("element face {}\nproperty list uchar int vertex_indices\nend_header\n", mesh.triangles.size());
  return out;
}

void write_vertices(const Mesh& mesh, const std::vector<Columns>& columns, OutputFile& file, const Task& task) {
  std::string record;
  for (std::uint32_t w = 0; w < mesh.wedge_count(); ++w) {
    if (w % 65536 == 0 && (task.cancelled() || file.failed())) break;
    record.clear();
    const std::uint32_t v = mesh.vertex_of(w);
    if (mesh.offset == Vec3d{}) {
      append(record, mesh.positions[v]);
    } else {
      append(record, mesh.position(v));
    }
    for (const Columns& c : columns) {
      for (std::size_t k = 0; k < c.names.size(); ++k) append_value(record, c, w * c.names.size() + k, k);
    }
    file.write(record);
  }
}

void write_faces(const Mesh& mesh, OutputFile& file, const Task& task) {
  std::string record(13, '\3');
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (t % 65536 == 0 && (task.cancelled() || file.failed())) break;
    std::memcpy(record.data() + 1, mesh.triangles[t].data(), 12);
    file.write(record);
  }
}

}  // namespace

Result<WriteReport> write_ply(const Model& model, const std::filesystem::path& path, Task task) {
  LODESTONE_TRY(check_drawn(model, path, task));
  std::vector<std::string> warnings;
  const Mesh mesh = flatten_to_mesh(model, warnings);
  const std::optional<TextureFile> texture = find_texture(model, mesh, path, warnings);
  std::optional<OutputFile> image;
  if (texture) {
    Result<OutputFile> created = write_texture(*texture, path);
    LODESTONE_TRY(created);
    image = std::move(*created);
  }
  Result<OutputFile> file = OutputFile::create(path);
  LODESTONE_TRY(file);
  const std::vector<Columns> columns = plan_columns(mesh, model.uv_origin_top);
  file->write(header_of(mesh, columns, texture ? texture->name : ""));
  write_vertices(mesh, columns, *file, task);
  write_faces(mesh, *file, task);
  if (task.cancelled()) return cancelled_error("writing");
  if (image) {
    LODESTONE_TRY(image->commit());
  }
  LODESTONE_TRY(file->commit());
  return single_file_report(path, file->size() + (image ? image->size() : 0), std::move(warnings));
}

}  // namespace lodestone::io
