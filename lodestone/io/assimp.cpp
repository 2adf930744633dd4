#include "lodestone/io/assimp.h"

#include <fmt/format.h>

#include "lodestone/base/file.h"
#include "lodestone/io/images/file_detail.h"
#include "lodestone/io/read_detail.h"

#ifdef LODESTONE_WITH_ASSIMP
#include <assimp/config.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <assimp/ProgressHandler.hpp>
#include <map>
#include <new>
#endif

namespace lodestone::io {

std::vector<std::string> assimp_extensions() {
  return {".fbx",  ".dae", ".3ds", ".3mf", ".x",   ".lwo", ".ac",  ".b3d", ".blend",
          ".ms3d", ".cob", ".ase", ".dxf", ".ifc", ".x3d", ".q3o", ".smd"};
}

#ifndef LODESTONE_WITH_ASSIMP

Result<Model> read_assimp(const std::filesystem::path& path, Task) {
  return fail(ErrorCode::unsupported,
              fmt::format("this build cannot read '{}': it was made without assimp", path.extension().string()),
              path.string(), "install libassimp-dev and build with -DLODESTONE_WITH_ASSIMP=ON");
}

#else

namespace {

// Lets assimp stop when the task is cancelled.
class Cancel : public Assimp::ProgressHandler {
 public:
  explicit Cancel(Task task) : task_(std::move(task)) {}
  bool Update(float) override { return !task_.cancelled(); }

 private:
  Task task_;
};

Mat4d to_matrix(const aiMatrix4x4& a) {
  Mat4d out;
  out.m = {double(a.a1), double(a.b1), double(a.c1), double(a.d1), double(a.a2), double(a.b2),
           double(a.c2), double(a.d2), double(a.a3), double(a.b3), double(a.c3), double(a.d3),
           double(a.a4), double(a.b4), double(a.c4), double(a.d4)};
  return out;
}

class SceneReader {
 public:
  SceneReader(const aiScene& scene, const std::filesystem::path& path) : scene_(scene), folder_(path.parent_path()) {}

  Model read() {
    model_.meters_per_unit = meters_per_unit();
    for (unsigned i = 0; i < scene_.mNumMaterials; ++i) model_.materials.push_back(material(*scene_.mMaterials[i]));
    place_nodes();
    warn();
    return std::move(model_);
  }

 private:
  // FBX tells centimetres a unit.
  double meters_per_unit() const {
    if (scene_.mMetaData == nullptr) return 0;
    double wide = 0;
    float single = 0;
    if (scene_.mMetaData->Get("UnitScaleFactor", wide)) return wide > 0 ? wide / 100 : 0;
    if (scene_.mMetaData->Get("UnitScaleFactor", single)) return single > 0 ? static_cast<double>(single) / 100 : 0;
    return 0;
  }

  Material material(const aiMaterial& from) {
    Material to;
    aiString text;
    aiColor4D color;
    float opacity = 1;
    int two_sided = 0;
    if (from.Get(AI_MATKEY_NAME, text) == aiReturn_SUCCESS) to.name = text.C_Str();
    if (from.Get(AI_MATKEY_COLOR_DIFFUSE, color) == aiReturn_SUCCESS) {
      const auto share = [](float v) { return v >= 0 ? std::min(v, 1.0F) : 0.0F; };
      to.base_color = {share(color.r), share(color.g), share(color.b), share(color.a)};
    }
    if (from.Get(AI_MATKEY_OPACITY, opacity) == aiReturn_SUCCESS && opacity >= 0 && opacity <= 1) {
      to.base_color[3] = opacity;
    }
    if (from.Get(AI_MATKEY_TWOSIDED, two_sided) == aiReturn_SUCCESS) to.double_sided = two_sided != 0;
    for (const aiTextureType type : {aiTextureType_DIFFUSE, aiTextureType_BASE_COLOR}) {
      if (!to.base_color_texture && from.GetTexture(type, 0, &text) == aiReturn_SUCCESS) {
        to.base_color_texture = image(text.C_Str());
      }
    }
    return to;
  }

  std::shared_ptr<const Image> image(const std::string& name) {
    const auto [at, is_new] = images_.try_emplace(name);
    if (is_new) at->second = load_image(name);
    return at->second;
  }

  std::shared_ptr<const Image> load_image(const std::string& name) {
    const aiTexture* embedded = scene_.GetEmbeddedTexture(name.c_str());
    if (embedded == nullptr) return load_image_near(folder_, name, model_.warnings);
    const auto out = std::make_shared<Image>();
    out->name = name.substr(name.find_last_of("/\\") + 1);
    if (embedded->mHeight != 0) {
      model_.warnings.push_back(fmt::format("the embedded texture '{}' is not compressed: left out", name));
      return out;
    }
    const auto* bytes = reinterpret_cast<const std::byte*>(embedded->pcData);
    out->encoded.assign(bytes, bytes + embedded->mWidth);
    out->mime = image_mime(out->encoded);
    if (out->name.starts_with('*'))
      out->name = fmt::format("texture_{}{}", out->name.substr(1), image_extension(out->mime));
    return out;
  }

  // Depth first, without recursion: files may nest as deep as they like.
  void place_nodes() {
    struct Visit {
      const aiNode* node;
      Mat4d parent;
    };
    std::vector<Visit> stack;
    if (scene_.mRootNode != nullptr) stack.push_back({scene_.mRootNode, Mat4d{}});
    while (!stack.empty()) {
      const Visit visit = stack.back();
      stack.pop_back();
      const aiNode& node = *visit.node;
      const Mat4d world = visit.parent * to_matrix(node.mTransformation);
      const std::uint32_t mesh = mesh_of(node);
      if (mesh != kNone) {
        Instance instance;
        instance.mesh = mesh;
        instance.transform = world;
        instance.name = node.mName.C_Str();
        model_.instances.push_back(std::move(instance));
      }
      for (unsigned i = node.mNumChildren; i-- > 0;) stack.push_back({node.mChildren[i], world});
    }
  }

  // Nodes with the same parts share a mesh. kNone for a node without triangles.
  std::uint32_t mesh_of(const aiNode& node) {
    std::vector<unsigned> parts;
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
      const unsigned part = node.mMeshes[i];
      if (part < scene_.mNumMeshes && scene_.mMeshes[part]->HasPositions() && scene_.mMeshes[part]->mNumFaces > 0) {
        parts.push_back(part);
      }
    }
    if (parts.empty()) return kNone;
    const auto [at, is_new] = mesh_of_parts_.try_emplace(parts, kNone);
    if (is_new) {
      Mesh mesh = join(parts);
      mesh.name = node.mName.C_Str();
      if (!mesh.triangles.empty()) {
        at->second = static_cast<std::uint32_t>(model_.meshes.size());
        model_.meshes.push_back(std::move(mesh));
      }
    }
    return at->second;
  }

  Mesh join(const std::vector<unsigned>& parts) {
    Mesh mesh;
    std::size_t vertices = 0;
    for (const unsigned part : parts) vertices += scene_.mMeshes[part]->mNumVertices;
    mesh.positions.reserve(vertices);
    for (std::size_t p = 0; p < parts.size(); ++p) {
      const aiMesh& from = *scene_.mMeshes[parts[p]];
      const auto first = static_cast<std::uint32_t>(mesh.positions.size());
      for (unsigned v = 0; v < from.mNumVertices; ++v) {
        mesh.positions.push_back({from.mVertices[v].x, from.mVertices[v].y, from.mVertices[v].z});
      }
      for (unsigned f = 0; f < from.mNumFaces; ++f) {
        const aiFace& face = from.mFaces[f];
        if (face.mNumIndices != 3) continue;
        const unsigned* corner = face.mIndices;
        if (std::max({corner[0], corner[1], corner[2]}) >= from.mNumVertices) continue;
        mesh.triangles.push_back({first + corner[0], first + corner[1], first + corner[2]});
        mesh.face_group.push_back(static_cast<std::uint32_t>(p));
      }
      mesh.groups.push_back(
          {from.mMaterialIndex < scene_.mNumMaterials ? from.mMaterialIndex : kNone, from.mName.C_Str()});
    }
    if (parts.size() == 1) mesh.face_group.clear();
    model_.file_vertices += vertices;
    model_.file_triangles += mesh.triangles.size();
    add_stream(
        mesh, parts, "NORMAL", Semantic::normal, 0, 3, [](const aiMesh& m) { return m.HasNormals(); },
        [](const aiMesh& m, unsigned v, float* to) { std::copy_n(&m.mNormals[v].x, 3, to); });
    for (unsigned set = 0; set < AI_MAX_NUMBER_OF_TEXTURECOORDS; ++set) {
      add_stream(
          mesh, parts, fmt::format("TEXCOORD_{}", set), Semantic::uv, set, 2,
          [set](const aiMesh& m) { return m.HasTextureCoords(set); },
          [set](const aiMesh& m, unsigned v, float* to) { std::copy_n(&m.mTextureCoords[set][v].x, 2, to); });
    }
    for (unsigned set = 0; set < AI_MAX_NUMBER_OF_COLOR_SETS; ++set) {
      add_stream(
          mesh, parts, fmt::format("COLOR_{}", set), Semantic::color, set, 4,
          [set](const aiMesh& m) { return m.HasVertexColors(set); },
          [set](const aiMesh& m, unsigned v, float* to) { std::copy_n(&m.mColors[set][v].r, 4, to); });
    }
    return mesh;
  }

  // A stream of all parts if at least one has it.
  template <class Has, class Get>
  void add_stream(Mesh& mesh, const std::vector<unsigned>& parts, std::string name, Semantic semantic,
                  std::uint32_t set, std::uint32_t components, Has has, Get get) {
    std::vector<std::uint8_t> present;
    for (const unsigned part : parts) present.push_back(has(*scene_.mMeshes[part]) ? 1 : 0);
    const auto count = std::count(present.begin(), present.end(), 1);
    if (count == 0) return;
    AttributeStream stream =
        make_stream(std::move(name), semantic, components, ComponentType::float32, false, mesh.positions.size());
    stream.set = set;
    float* to = std::get<std::vector<float> >(stream.values).data();
    for (std::size_t p = 0; p < parts.size(); ++p) {
      const aiMesh& from = *scene_.mMeshes[parts[p]];
      for (unsigned v = 0; v < from.mNumVertices; ++v, to += components) {
        if (present[p]) get(from, v, to);
      }
    }
    if (count < static_cast<std::ptrdiff_t>(parts.size())) stream.present = std::move(present);
    mesh.attributes.push_back(std::move(stream));
  }

  void warn() {
    bool bones = false;
    for (unsigned i = 0; i < scene_.mNumMeshes; ++i) bones = bones || scene_.mMeshes[i]->HasBones();
    const auto left_out = [&](bool there, const char* what) {
      if (there) model_.warnings.push_back(fmt::format("{} were left out", what));
    };
    left_out(bones, "bones");
    left_out(scene_.mNumAnimations > 0, "animations");
    left_out(scene_.mNumCameras > 0, "cameras");
    left_out(scene_.mNumLights > 0, "lights");
  }

  const aiScene& scene_;
  std::filesystem::path folder_;
  Model model_;
  std::map<std::vector<unsigned>, std::uint32_t> mesh_of_parts_;
  std::map<std::string, std::shared_ptr<const Image> > images_;
};

Result<Model> read_scene(const std::filesystem::path& path, const Task& task) {
  Assimp::Importer importer;
  importer.SetProgressHandler(new Cancel(task));  // the importer deletes it
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  const aiScene* scene = importer.ReadFile(path.string(), aiProcess_Triangulate | aiProcess_SortByPType);
  if (task.cancelled()) return cancelled_error("reading");
  if (scene == nullptr) {
    return fail(ErrorCode::bad_format, fmt::format("assimp cannot read it: {}", importer.GetErrorString()),
                path.string());
  }
  return SceneReader(*scene, path).read();
}

}  // namespace

Result<Model> read_assimp(const std::filesystem::path& path, Task task) {
  Result<InputFile> file = InputFile::open(path);  // its errors are clearer than assimp's
  LODESTONE_TRY(file);
  if (file->size() == 0) return fail(ErrorCode::empty, "is empty (0 bytes)", path.string());
  try {
    Result<Model> model = read_scene(path, task.part(kReadingShare));
    if (!model) return model;
    return finish_model(std::move(*model), path.string(), 0, task.part(1 - kReadingShare));
  } catch (const std::bad_alloc&) {
    return fail(ErrorCode::out_of_memory, "not enough memory to read it", path.string());
  } catch (const std::exception& error) {
    return fail(ErrorCode::bad_format, fmt::format("assimp cannot read it: {}", error.what()), path.string());
  }
}

#endif

}  // namespace lodestone::io
