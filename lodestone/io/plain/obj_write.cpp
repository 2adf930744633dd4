#include "lodestone/io/plain/obj_write.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "lodestone/base/file.h"
#include "lodestone/core/flatten.h"
#include "lodestone/io/images/file_detail.h"
#include "lodestone/io/plain/mtl_detail.h"
#include "lodestone/io/read_detail.h"
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

// The word, made different from all that are taken.
std::string new_word(std::string_view name, std::string_view fallback, std::set<std::string>& taken) {
  std::string out = word(name, fallback);
  while (!taken.insert(out).second) out += "_";
  return out;
}

// What the .mtl holds, and the words of `usemtl` and `g` for each group; empty words: the line is left out.
struct ObjNames {
  std::vector<Material> materials;
  std::vector<std::string> material_words;  // one a material
  std::vector<std::string> usemtl, o, g;    // one a group
};

// Without a `usemtl` of its own, a group would get that of the group before it: where some have a material, the others
// get a white one that stands for none.
void name_materials(const Model& model, const Mesh& mesh, ObjNames& names) {
  names.materials = model.materials;
  std::set<std::string> taken;
  for (std::size_t i = 0; i < model.materials.size(); ++i) {
    names.material_words.push_back(new_word(model.materials[i].name, fmt::format("material_{}", i), taken));
  }
  const auto has_material = [&](const FaceGroup& g) { return g.material < model.materials.size(); };
  const bool any = std::any_of(mesh.groups.begin(), mesh.groups.end(), has_material);
  const bool all = std::all_of(mesh.groups.begin(), mesh.groups.end(), has_material);
  std::string none;
  if (any && !all) {
    none = new_word("none", {}, taken);
    names.materials.emplace_back();
    names.material_words.push_back(none);
  }
  for (const FaceGroup& g : mesh.groups) {
    names.usemtl.push_back(has_material(g) ? names.material_words[g.material] : none);
  }
}

// A word for each name, the same for the same one; for none "default", which is what OBJ calls faces before the first
// name, where others have one.
class NameWords {
 public:
  void add(const std::string& name) {
    if (!name.empty() && !words_.contains(name)) words_[name] = new_word(name, {}, taken_);
  }
  std::string word(const std::string& name) {
    if (words_.empty()) return {};
    if (name.empty() && !words_.contains(name)) words_[name] = new_word("default", {}, taken_);
    return words_[name];
  }
  bool empty() const { return words_.empty(); }

 private:
  std::set<std::string> taken_;
  std::map<std::string, std::string> words_;
};

// The same for `o` and `g`. A part begins without a group, so a group that is all of its part needs no line.
void name_groups(const Mesh& mesh, ObjNames& names) {
  NameWords objects, groups;
  for (const FaceGroup& g : mesh.groups) {
    objects.add(g.object);
    if (g.name != g.object) groups.add(g.name);
  }
  for (const FaceGroup& g : mesh.groups) {
    const bool named = objects.empty() || (!g.name.empty() && g.name != g.object);
    names.o.push_back(objects.word(g.object));
    names.g.push_back(named ? groups.word(g.name) : std::string());
  }
}

// The numbers of a stream, in the precision that it has.
struct Numbers {
  const float* floats = nullptr;
  const double* doubles = nullptr;
  std::size_t width = 0;  // numbers a wedge

  explicit operator bool() const { return floats != nullptr || doubles != nullptr; }
  double operator[](std::size_t i) const { return floats != nullptr ? static_cast<double>(floats[i]) : doubles[i]; }
  void append(std::string& line, std::size_t i, bool turned = false) const {
    if (floats != nullptr) {
      append_number(line, turned ? 1 - floats[i] : floats[i]);
    } else {
      append_number(line, turned ? 1 - doubles[i] : doubles[i]);
    }
  }
};

// None for a stream that OBJ does not hold.
Numbers numbers_of(const AttributeStream& s) {
  const bool held = s.set == 0 && ((s.semantic == Semantic::uv && s.components == 2) ||
                                   (s.semantic == Semantic::normal && s.components == 3) ||
                                   (s.semantic == Semantic::color && s.components >= 3));
  Numbers out;
  if (!held) return out;
  out.width = s.components;
  if (const auto* floats = std::get_if<std::vector<float>>(&s.values)) out.floats = floats->data();
  if (const auto* doubles = std::get_if<std::vector<double>>(&s.values)) out.doubles = doubles->data();
  return out;
}

Numbers find_numbers(const Mesh& mesh, Semantic semantic) {
  const AttributeStream* stream = find_stream(mesh, semantic);
  return stream == nullptr ? Numbers{} : numbers_of(*stream);
}

// OBJ has one colour a vertex: its first wedge's.
std::vector<std::uint32_t> first_wedges(const Mesh& mesh) {
  std::vector<std::uint32_t> first(mesh.vertex_count(), 0);
  for (auto w = static_cast<std::uint32_t>(mesh.wedge_count()); w-- > 0;) first[mesh.vertex_of(w)] = w;
  return first;
}

class ObjText {
 public:
  ObjText(const Model& model, const Mesh& mesh, OutputFile& file, const Task& task)
      : model_(model),
        mesh_(mesh),
        file_(file),
        task_(task),
        uv_(find_numbers(mesh, Semantic::uv)),
        normal_(find_numbers(mesh, Semantic::normal)),
        color_(find_numbers(mesh, Semantic::color)) {}

  void write(const ObjNames& names) {
    write_vertices();
    write_wedges("vt", uv_, model_.uv_origin_top);
    write_wedges("vn", normal_, false);
    write_faces(names);
  }

 private:
  bool stop(std::size_t i) const { return i % 65536 == 0 && (task_.cancelled() || file_.failed()); }

  void write_vertices() {
    const std::vector<std::uint32_t> wedge = color_ ? first_wedges(mesh_) : std::vector<std::uint32_t>{};
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
      for (std::size_t k = 0; color_ && k < 3; ++k) {
        line += ' ';
        color_.append(line, wedge[v] * color_.width + k);
      }
      line += '\n';
      file_.write(line);
    }
  }

  void write_wedges(const char* key, const Numbers& numbers, bool turn_second) {
    if (!numbers) return;
    std::string line;
    for (std::size_t w = 0; w < mesh_.wedge_count(); ++w) {
      if (stop(w)) return;
      line = key;
      for (std::size_t k = 0; k < numbers.width; ++k) {
        line += ' ';
        numbers.append(line, w * numbers.width + k, turn_second && k == 1);
      }
      line += '\n';
      file_.write(line);
    }
  }

  void write_faces(const ObjNames& names) {
    std::uint32_t group = kNone;
    std::string line, object, name;  // the present `o` and `g`
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      if (stop(t)) return;
      if (!mesh_.groups.empty() && mesh_.group_of(t) != group) {
        group = mesh_.group_of(t);
        if (names.o[group] != object || (!names.o[group].empty() && names.g[group].empty() && !name.empty())) {
          object = names.o[group];
          name.clear();
          file_.write(fmt::format("o {}\n", object));
        }
        if (!names.g[group].empty() && (object.empty() || names.g[group] != name)) {
          name = names.g[group];
          file_.write(fmt::format("g {}\n", name));
        }
        if (!names.usemtl[group].empty()) file_.write(fmt::format("usemtl {}\n", names.usemtl[group]));
      }
      line = "f";
      for (const std::uint32_t w : mesh_.triangles[t]) {
        line += fmt::format(" {}", mesh_.vertex_of(w) + 1);
        if (uv_ && normal_) {
          line += fmt::format("/{}/{}", w + 1, w + 1);
        } else if (uv_) {
          line += fmt::format("/{}", w + 1);
        } else if (normal_) {
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
  Numbers uv_, normal_, color_;
};

void warn_of_left_out_colors(const Mesh& mesh, const Numbers& color, std::vector<std::string>& warnings) {
  const std::vector<std::uint32_t> first = first_wedges(mesh);
  std::vector<bool> several(mesh.vertex_count(), false);
  bool has_alpha = false;
  for (std::uint32_t w = 0; w < mesh.wedge_count(); ++w) {
    const std::uint32_t v = mesh.vertex_of(w);
    for (std::size_t k = 0; k < 3; ++k) {
      if (color[w * color.width + k] != color[first[v] * color.width + k]) several[v] = true;
    }
    has_alpha = has_alpha || (color.width > 3 && color[w * color.width + 3] != 1);
  }
  const auto count = static_cast<std::uint64_t>(std::count(several.begin(), several.end(), true));
  if (count > 0) {
    warnings.push_back(fmt::format("OBJ holds one colour a vertex: {} with several keep the first",
                                   counted(count, "vertex", "vertices")));
  }
  if (has_alpha) warnings.push_back("OBJ does not hold the alpha of colours: left out");
}

void warn_of_left_out(const Mesh& mesh, std::vector<std::string>& warnings) {
  for (const AttributeStream& s : mesh.attributes) {
    if (!numbers_of(s)) warnings.push_back(fmt::format("OBJ does not hold attribute '{}': left out", s.name));
  }
  if (const Numbers color = find_numbers(mesh, Semantic::color)) warn_of_left_out_colors(mesh, color, warnings);
}

// The .mtl and the textures that it names, written but not yet under their names.
Result<void> write_materials(const ObjNames& names, const std::filesystem::path& path, std::vector<OutputFile>& files) {
  const std::vector<TextureFile> textures = texture_files(names.materials, path, true);
  Result<OutputFile> mtl =
      OutputFile::create(std::filesystem::path(path).replace_filename(path.stem().string() + ".mtl"));
  LODESTONE_TRY(mtl);
  mtl->write(mtl_text(names.materials, names.material_words, textures));
  files.push_back(std::move(*mtl));
  for (const TextureFile& texture : textures) {
    Result<OutputFile> image = write_texture(texture, path);
    LODESTONE_TRY(image);
    files.push_back(std::move(*image));
  }
  return {};
}

}  // namespace

Result<WriteReport> write_obj(const Model& model, const std::filesystem::path& path, Task task) {
  LODESTONE_TRY(check_drawn(model, path, task));
  std::vector<std::string> warnings;
  const Mesh mesh = flatten_to_mesh(model, warnings);
  warn_of_left_out(mesh, warnings);
  ObjNames names;
  name_materials(model, mesh, names);
  name_groups(mesh, names);

  std::vector<OutputFile> files;
  Result<OutputFile> obj = OutputFile::create(path);
  LODESTONE_TRY(obj);
  obj->write("# made by Lodestone\n");
  if (!names.materials.empty()) {
    obj->write(fmt::format("mtllib {}.mtl\n", path.stem().string()));
    LODESTONE_TRY(write_materials(names, path, files));
  }
  ObjText(model, mesh, *obj, task).write(names);
  if (task.cancelled()) return cancelled_error("writing");
  files.push_back(std::move(*obj));
  WriteReport report = single_file_report(path, 0, std::move(warnings));
  for (OutputFile& file : files) {
    LODESTONE_TRY(file.commit());
    report.total_bytes += file.size();
  }
  report.level_bytes = {report.total_bytes};
  return report;
}

}  // namespace lodestone::io
