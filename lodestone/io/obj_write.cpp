#include "lodestone/io/obj_write.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "lodestone/base/file.h"
#include "lodestone/io/flat_mesh_detail.h"
#include "lodestone/io/write_detail.h"

namespace lodestone::io {

namespace {

// A word: OBJ has no quotes.
std::string word(std::string_view name, std::string_view fallback) {
  std::string out(name.empty() ? fallback : name);
  for (char& c : out) {
    if (c == ' ' || c == '\\' || static_cast<unsigned char>(c) < 0x21) c = '_';
  }
  return out;
}

std::vector<std::string> material_names(const Model& model) {
  std::vector<std::string> names;
  std::set<std::string> taken;
  for (std::size_t i = 0; i < model.materials.size(); ++i) {
    std::string name = word(model.materials[i].name, fmt::format("material_{}", i));
    while (!taken.insert(name).second) name += "_";
    names.push_back(std::move(name));
  }
  return names;
}

// Texture files beside the OBJ: their last path component, made different where two images have the same.
std::map<const Image*, std::string> texture_files(const Model& model, const std::string& stem) {
  std::map<const Image*, std::string> files;
  std::set<std::string> taken;
  for (const Material& m : model.materials) {
    const Image* image = m.base_color_texture.get();
    if (image == nullptr || image->encoded.empty() || files.contains(image)) continue;
    std::string name = std::filesystem::path(image->name).filename().string();
    const std::string extension = image->mime == "image/jpeg" ? ".jpg" : image->mime == "image/webp" ? ".webp" : ".png";
    if (name.empty()) name = fmt::format("{}_texture{}", stem, files.size());
    if (std::filesystem::path(name).extension().empty()) name += extension;
    while (!taken.insert(name).second) name = "_" + name;
    files[image] = name;
  }
  return files;
}

std::string mtl_text(const Model& model, const std::vector<std::string>& names,
                     const std::map<const Image*, std::string>& textures) {
  std::string out = "# made by Lodestone\n";
  for (std::size_t i = 0; i < model.materials.size(); ++i) {
    const Material& m = model.materials[i];
    out += fmt::format("newmtl {}\nKd {} {} {}\nd {}\n", names[i], m.base_color[0], m.base_color[1], m.base_color[2],
                       m.base_color[3]);
    const auto texture = textures.find(m.base_color_texture.get());
    if (texture != textures.end()) out += fmt::format("map_Kd {}\n", texture->second);
  }
  return out;
}

const std::vector<float>* floats_of(const Mesh& mesh, Semantic semantic, std::size_t components) {
  const AttributeStream* stream = find_stream(mesh, semantic);
  if (stream == nullptr || stream->components != components) return nullptr;
  return std::get_if<std::vector<float>>(&stream->values);
}

class ObjText {
 public:
  ObjText(const Model& model, const Mesh& mesh, OutputFile& file, const Task& task)
      : model_(model),
        mesh_(mesh),
        file_(file),
        task_(task),
        uv_(floats_of(mesh, Semantic::uv, 2)),
        normal_(floats_of(mesh, Semantic::normal, 3)) {
    const AttributeStream* color = find_stream(mesh, Semantic::color);
    if (color != nullptr && color->components >= 3) {
      color_ = std::get_if<std::vector<float>>(&color->values);
      color_width_ = color->components;
    }
  }

  void write(const std::vector<std::string>& materials) {
    write_vertices();
    write_wedges("vt", uv_, 2);
    write_wedges("vn", normal_, 3);
    write_faces(materials);
  }

 private:
  bool stop(std::size_t i) const { return i % 65536 == 0 && (task_.cancelled() || file_.failed()); }

  void write_vertices() {
    std::vector<std::uint32_t> wedge(mesh_.vertex_count(), 0);  // OBJ has one colour a vertex: its first wedge's
    if (color_ != nullptr) {
      for (std::uint32_t w = static_cast<std::uint32_t>(mesh_.wedge_count()); w-- > 0;) wedge[mesh_.vertex_of(w)] = w;
    }
    std::string line;
    for (std::uint32_t v = 0; v < mesh_.vertex_count(); ++v) {
      if (stop(v)) return;
      line = "v";
      for (std::size_t k = 0; k < 3; ++k) {
        line += ' ';
        if (mesh_.offset == Vec3d{}) {
          append_number(line, mesh_.positions[v][k]);
        } else {
          append_number(line, mesh_.position(v)[k]);
        }
      }
      for (std::size_t k = 0; color_ != nullptr && k < 3; ++k) {
        line += ' ';
        append_number(line, (*color_)[wedge[v] * color_width_ + k]);
      }
      line += '\n';
      file_.write(line);
    }
  }

  void write_wedges(const char* key, const std::vector<float>* values, std::size_t n) {
    if (values == nullptr) return;
    std::string line;
    for (std::size_t w = 0; w < mesh_.wedge_count(); ++w) {
      if (stop(w)) return;
      line = key;
      for (std::size_t k = 0; k < n; ++k) {
        float value = (*values)[w * n + k];
        if (n == 2 && k == 1 && model_.uv_origin_top) value = 1 - value;
        line += ' ';
        append_number(line, value);
      }
      line += '\n';
      file_.write(line);
    }
  }

  void write_faces(const std::vector<std::string>& materials) {
    std::uint32_t group = kNone;
    std::string line;
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      if (stop(t)) return;
      if (!mesh_.groups.empty() && mesh_.group_of(t) != group) {
        group = mesh_.group_of(t);
        const FaceGroup& g = mesh_.groups[group];
        if (!g.name.empty()) file_.write(fmt::format("g {}\n", word(g.name, "default")));
        if (g.material < materials.size()) file_.write(fmt::format("usemtl {}\n", materials[g.material]));
      }
      line = "f";
      for (const std::uint32_t w : mesh_.triangles[t]) {
        line += fmt::format(" {}", mesh_.vertex_of(w) + 1);
        if (uv_ != nullptr && normal_ != nullptr) {
          line += fmt::format("/{}/{}", w + 1, w + 1);
        } else if (uv_ != nullptr) {
          line += fmt::format("/{}", w + 1);
        } else if (normal_ != nullptr) {
          line += fmt::format("//{}", w + 1);
        }
      }
      line += '\n';
      file_.write(line);
    }
  }

  const Model& model_;
  const Mesh& mesh_;
  OutputFile& file_;
  const Task& task_;
  const std::vector<float>* uv_;
  const std::vector<float>* normal_;
  const std::vector<float>* color_ = nullptr;
  std::size_t color_width_ = 3;
};

void warn_of_left_out(const Mesh& mesh, std::vector<std::string>& warnings) {
  for (const AttributeStream& s : mesh.attributes) {
    const bool held = s.set == 0 && ((s.semantic == Semantic::uv && s.components == 2) ||
                                     s.semantic == Semantic::normal || s.semantic == Semantic::color);
    if (!held) warnings.push_back(fmt::format("OBJ does not hold attribute '{}': left out", s.name));
  }
}

}  // namespace

Result<WriteReport> write_obj(const Model& model, const std::filesystem::path& path, Task task) {
  if (const Result<void> ok = check_drawn(model, path); !ok) return fail(ok.error());
  std::vector<std::string> warnings;
  const Mesh mesh = flatten_to_mesh(model, warnings);
  warn_of_left_out(mesh, warnings);
  const std::vector<std::string> names = material_names(model);
  const std::string stem = path.stem().string();

  std::vector<OutputFile> files;
  Result<OutputFile> obj = OutputFile::create(path);
  if (!obj) return fail(obj.error());
  obj->write("# made by Lodestone\n");
  if (!model.materials.empty()) {
    obj->write(fmt::format("mtllib {}.mtl\n", stem));
    const std::map<const Image*, std::string> textures = texture_files(model, stem);
    Result<OutputFile> mtl = OutputFile::create(std::filesystem::path(path).replace_filename(stem + ".mtl"));
    if (!mtl) return fail(mtl.error());
    mtl->write(mtl_text(model, names, textures));
    files.push_back(std::move(*mtl));
    for (const Material& m : model.materials) {
      const auto texture = textures.find(m.base_color_texture.get());
      if (texture == textures.end()) continue;
      const std::filesystem::path image_path = std::filesystem::path(path).replace_filename(texture->second);
      if (std::any_of(files.begin(), files.end(), [&](const OutputFile& f) { return f.path() == image_path; }))
        continue;
      Result<OutputFile> image = OutputFile::create(image_path);
      if (!image) return fail(image.error());
      image->write(std::span<const std::byte>(texture->first->encoded));
      files.push_back(std::move(*image));
    }
  }
  ObjText(model, mesh, *obj, task).write(names);
  if (task.cancelled()) return cancelled_error("writing");
  files.push_back(std::move(*obj));
  WriteReport report = single_file_report(path, 0, std::move(warnings));
  for (OutputFile& file : files) {
    if (const Result<void> ok = file.commit(); !ok) return fail(ok.error());
    report.total_bytes += file.size();
  }
  report.level_bytes = {report.total_bytes};
  return report;
}

}  // namespace lodestone::io
