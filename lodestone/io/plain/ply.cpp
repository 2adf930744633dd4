#include "lodestone/io/plain/ply.h"

#include <fmt/format.h>

#include "lodestone/io/images/file_detail.h"
#include "lodestone/io/plain/ply_faces_detail.h"
#include "lodestone/io/plain/ply_header_detail.h"
#include "lodestone/io/plain/ply_values_detail.h"
#include "lodestone/io/plain/ply_vertices_detail.h"
#include "lodestone/io/read_detail.h"

namespace lodestone::io {

namespace {

enum class Role { vertices, faces, strips, other };

Role role_of(const PlyElement& element) {
  if (element.name == "vertex") return Role::vertices;
  if (element.name == "face") return Role::faces;
  if (element.name == "tristrips") return Role::strips;
  return Role::other;
}

Result<void> skip_element(PlyValues& values, const PlyElement& element, ReadProgress& progress) {
  if (element.properties.empty()) return {};
  for (std::uint64_t i = 0; i < element.count; ++i) {
    for (const PlyProperty& p : element.properties) {
      if (!values.skip(p)) return fail(values.error(fmt::format("{} {} of {}", element.name, i, element.count)));
    }
    if (i % 4096 == 0 && !progress.go_on(values.bytes().position())) return cancelled_error("reading");
  }
  return {};
}

// Walks over all elements; `wanted` says which are read and which only stepped over.
template <class Wanted>
Result<void> walk(ByteReader& bytes, const PlyHeader& header, Model& model, ReadProgress& progress, Wanted wanted) {
  bytes.seek(header.data_begin);
  PlyValues values(bytes, header);
  for (const PlyElement& element : header.elements) {
    const Role role = role_of(element);
    Result<void> done;
    if (!wanted(role)) {
      done = skip_element(values, element, progress);
    } else if (role == Role::vertices) {
      done = read_ply_vertices(values, element, model, progress);
    } else if (role == Role::faces) {
      done = read_ply_faces(values, element, model, progress);
    } else {
      done = read_ply_strips(values, element, model, progress);
    }
    if (!done) return done;
  }
  return {};
}

// Faces need their vertices: where these come later in the file, it is read twice.
Result<void> read_elements(ByteReader& bytes, const PlyHeader& header, Model& model, ReadProgress& progress) {
  bool has_vertices = false, faces_first = false;
  for (const PlyElement& element : header.elements) {
    const Role role = role_of(element);
    if (role == Role::vertices) has_vertices = true;
    if (!has_vertices && (role == Role::faces || role == Role::strips)) faces_first = true;
    if (role == Role::other && element.count > 0) {
      model.warnings.push_back(fmt::format("element '{}' was left out", element.name));
    }
  }
  if (!has_vertices) return {};
  if (!faces_first) {
    return walk(bytes, header, model, progress, [](Role role) { return role != Role::other; });
  }
  if (Result<void> done = walk(bytes, header, model, progress, [](Role role) { return role == Role::vertices; });
      !done) {
    return done;
  }
  return walk(bytes, header, model, progress, [](Role role) { return role == Role::faces || role == Role::strips; });
}

void add_textures(const PlyHeader& header, const std::filesystem::path* folder, Model& model) {
  if (header.textures.empty() || find_stream(model.meshes[0], Semantic::uv) == nullptr) return;
  if (header.textures.size() > 1) {
    model.warnings.push_back(fmt::format("only the first of {} textures was taken", header.textures.size()));
  }
  Material material;
  material.name = header.textures[0];
  if (folder != nullptr) material.base_color_texture = load_image_near(*folder, header.textures[0], model.warnings);
  model.materials.push_back(std::move(material));
  model.meshes[0].groups = {FaceGroup{0, {}}};
}

Result<Model> read(ByteReader bytes, const std::filesystem::path* folder, Task task) {
  Result<PlyHeader> header = read_ply_header(bytes);
  LODESTONE_TRY(header);
  Model model = make_model(Mesh{});
  {
    ReadProgress progress(task.part(kReadingShare), bytes.size());
    LODESTONE_TRY(read_elements(bytes, *header, model, progress));
  }
  LODESTONE_TRY(bytes.status());
  model.file_vertices = model.meshes[0].positions.size();
  add_textures(*header, folder, model);
  return finish_model(std::move(model), bytes.name(), 0, task.part(1 - kReadingShare));
}

}  // namespace

Result<Model> read_ply(const std::filesystem::path& path, Task task) {
  Result<ByteReader> bytes = ByteReader::open(path);
  LODESTONE_TRY(bytes);
  const std::filesystem::path folder = path.parent_path();
  return read(std::move(*bytes), &folder, std::move(task));
}

Result<Model> read_ply(std::span<const std::byte> bytes, std::string_view name, Task task) {
  return read(ByteReader::over(bytes, std::string(name)), nullptr, std::move(task));
}

}  // namespace lodestone::io
