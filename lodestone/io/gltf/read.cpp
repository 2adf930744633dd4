#include "lodestone/io/gltf/read.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <new>
#include <utility>

#include "lodestone/base/file.h"
#include "lodestone/base/random.h"
#include "lodestone/core/validate.h"
#include "lodestone/core/weld.h"
#include "lodestone/io/gltf/gltf_detail.h"
#include "lodestone/io/gltf/primitive_detail.h"
#include "lodestone/io/gltf/repair_detail.h"

namespace lodestone::io {

namespace {

constexpr std::string_view kKnownExtensions[] = {"KHR_mesh_quantization",
                                                 "KHR_texture_transform",
                                                 "KHR_materials_unlit",
                                                 "KHR_lights_punctual",
                                                 kDraco,
                                                 kMeshoptNames[0],
                                                 kMeshoptNames[1],
                                                 kInstancing,
                                                 kMsftLod};

// An extension that is required and may change the geometry in ways that we don't know must not be ignored silently.
void warn_of_required(const Document::Data& data, std::vector<std::string>& warnings) {
  for (const Json& name : array_member(data.json, "extensionsRequired")) {
    if (!name.is_string()) continue;
    const std::string text = name.get<std::string>();
    const bool known =
        std::find(std::begin(kKnownExtensions), std::end(kKnownExtensions), text) != std::end(kKnownExtensions);
    const bool of_materials =
        text.starts_with("KHR_materials_") || text.starts_with("KHR_texture_") || text.starts_with("EXT_texture_");
    if (!known && !of_materials) {
      warnings.push_back(fmt::format("{} is required by the file and not understood: kept as it is", text));
    }
  }
}

Result<void> read_meshes(const Document::Data& data, Model& model, Budget& budget, const Task& task) {
  const std::size_t count = array_member(data.json, "meshes").size();
  DracoCache cache;
  for (std::size_t i = 0; i < count; ++i) {
    const Task part = task.part(1.0 / static_cast<double>(count));
    Result<Mesh> mesh = read_mesh(data, i, budget, cache, model, part);
    LODESTONE_TRY(mesh);
    Result<Mesh> welded = weld_exact(std::move(*mesh), part);
    LODESTONE_TRY(welded);
    if (const Result<void> ok = validate(*welded); !ok) {
      return fail(ErrorCode::bad_format, ok.error().what, place(data, "mesh", i), ok.error().remedy);
    }
    model.meshes.push_back(std::move(*welded));
  }
  return {};
}

Result<Model> read_document(std::string bytes, std::string name, const std::filesystem::path& path,
                            const ReadOptions& options, const Task& task) {
  Model model;
  model.meters_per_unit = 1;
  model.uv_origin_top = true;
  Result<std::unique_ptr<Document::Data>> loaded =
      load_document(std::move(bytes), std::move(name), path, options, model.warnings, task.part(0.3));
  LODESTONE_TRY(loaded);
  Document::Data& data = **loaded;
  model.files = data.files;
  warn_of_required(data, model.warnings);
  Budget budget = unfold_budget(data.file_bytes);
  LODESTONE_TRY(read_meshes(data, model, budget, task.part(0.7)));
  LODESTONE_TRY(read_scene(data, model, budget, options.draw_level));
  if (model.instances.empty()) {
    return fail(ErrorCode::empty, "has no triangles: the scene draws no mesh", data.name, "is it the right file?");
  }
  model.materials = read_materials(data);
  for (std::size_t m = 0; m < model.meshes.size(); ++m) {
    Mesh& mesh = model.meshes[m];
    data.fingerprints.push_back(fingerprint(mesh));  // before anything is mended: a mended mesh is written anew
    const std::string called = mesh.name.empty() ? fmt::format("mesh {}", m) : mesh.name;
    if (const std::uint64_t bad = zero_non_finite(mesh); bad > 0) {
      model.warnings.push_back(fmt::format("{}: {} attribute values were not finite: set to zero", called, bad));
    }
    if (repair_skin(mesh, joint_count_of(data.json, m))) {
      model.warnings.push_back(fmt::format("{}: skin weights were not valid: put right", called));
    }
  }
  model.document = std::make_shared<const Document>(std::move(*loaded));
  return model;
}

// Four lanes, so that a word need not wait for the one before it.
std::uint64_t hash_bytes(const void* data, std::size_t bytes) {
  const auto* p = static_cast<const unsigned char*>(data);
  std::array<std::uint64_t, 4> lanes{1, 2, 3, 4}, words;
  for (; bytes >= sizeof words; p += sizeof words, bytes -= sizeof words) {
    std::memcpy(&words, p, sizeof words);
    for (std::size_t k = 0; k < 4; ++k) lanes[k] = mix_bits(lanes[k] ^ words[k]);
  }
  words = {};
  if (bytes > 0) std::memcpy(&words, p, bytes);
  for (std::size_t k = 0; k < 4; ++k) lanes[0] = mix_bits(mix_bits(lanes[0] ^ lanes[k]) ^ words[k]);
  return lanes[0];
}

}  // namespace

std::uint64_t fingerprint(const Mesh& mesh) {
  std::uint64_t hash = mix_bits(mesh.positions.size());
  const auto add = [&](const void* data, std::size_t bytes) { hash = mix_bits(hash ^ hash_bytes(data, bytes)); };
  add(mesh.positions.data(), mesh.positions.size() * sizeof(Vec3f));
  add(mesh.triangles.data(), mesh.triangles.size() * sizeof(Triangle));
  add(mesh.wedge_vertex.data(), mesh.wedge_vertex.size() * 4);
  add(mesh.face_group.data(), mesh.face_group.size() * 4);
  for (const AttributeStream& stream : mesh.attributes) {
    std::visit([&](const auto& values) { add(values.data(), values.size() * sizeof(values[0])); }, stream.values);
  }
  return hash;
}

namespace {

tl::unexpected<Error> no_memory(const std::string& name) {
  return fail(ErrorCode::out_of_memory, "needs more memory than there is", name,
              "use a machine with more, or a smaller model");
}

}  // namespace

Result<Model> read_gltf_bytes(std::string bytes, std::string name, Task task) {
  try {
    return read_document(std::move(bytes), name, {}, {}, task);
  } catch (const std::bad_alloc&) {
    return no_memory(name);
  }
}

Result<Model> read_gltf(const std::filesystem::path& path, const ReadOptions& options, Task task) {
  try {
    Result<std::string> bytes = read_file(path);
    LODESTONE_TRY(bytes);
    return read_document(std::move(*bytes), path.string(), path, options, task);
  } catch (const std::bad_alloc&) {
    return no_memory(path.string());
  }
}

}  // namespace lodestone::io
