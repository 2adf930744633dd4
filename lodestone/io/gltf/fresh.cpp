#include "lodestone/io/gltf/fresh_detail.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <map>

#include "lodestone/io/plain/mtl_detail.h"

namespace lodestone::io {

namespace {

Json fresh_mesh(const Mesh& mesh, std::size_t materials) {
  Json out = Json::object();
  if (!mesh.name.empty()) out["name"] = mesh.name;
  out["primitives"] = fresh_primitives(mesh, materials);
  return out;
}

Json fresh_node(const Model& model, std::size_t index) {
  const Instance& instance = model.instances[index];
  const Mesh& mesh = model.meshes[instance.mesh];
  Json out = Json::object();
  const std::string& name = instance.name.empty() ? mesh.name : instance.name;
  if (!name.empty()) out["name"] = name;
  out["mesh"] = instance.mesh;
  place_fresh_node(out, fresh_placing(model, index));
  return out;
}

// What the world needs to be in metres, with Y up.
Mat4d world_to_gltf(const Model& model) {
  const double metres = model.meters_per_unit > 0 ? model.meters_per_unit : 1;
  return Mat4d::scale({metres, metres, metres}) * model.gltf_axes;
}

// One node above all others.
void add_root(const Mat4d& transform, Json& json, Json& roots) {
  Json root = {{"name", "to_metres_and_y_up"}, {"children", std::move(roots)}};
  if (transform == Mat4d::scale({transform.m[0], transform.m[0], transform.m[0]})) {
    root["scale"] = {transform.m[0], transform.m[0], transform.m[0]};
  } else {
    root["matrix"] = transform.m;
  }
  roots = Json::array({json["nodes"].size()});
  json["nodes"].push_back(std::move(root));
}

}  // namespace

Mat4d fresh_placing(const Model& model, std::size_t instance) {
  const Instance& placed = model.instances[instance];
  return placed.transform * Mat4d::translation(model.meshes[placed.mesh].offset);
}

void place_fresh_node(Json& node, const Mat4d& placing) {
  for (const char* key : {"translation", "matrix"}) node.erase(key);
  if (placing.is_identity()) return;
  Mat4d linear = placing;
  linear.m[12] = linear.m[13] = linear.m[14] = 0;
  if (linear.is_identity()) {
    node["translation"] = {placing.m[12], placing.m[13], placing.m[14]};
  } else {
    node["matrix"] = placing.m;
  }
}

Json fresh_primitives(const Mesh& mesh, std::size_t materials) {
  Json primitives = Json::array();
  for (std::size_t g = 0; g < std::max<std::size_t>(1, mesh.groups.size()); ++g) {
    Json primitive = Json::object();
    const std::uint32_t material = g < mesh.groups.size() ? mesh.groups[g].material : kNone;
    if (material < materials) primitive["material"] = material;
    if (g < mesh.groups.size() && !mesh.groups[g].name.empty()) primitive["extras"] = {{"name", mesh.groups[g].name}};
    primitives.push_back(std::move(primitive));
  }
  return primitives;
}

Json make_fresh_document(const Model& model) {
  Json json = {{"asset", {{"version", "2.0"}, {"generator", "Lodestone"}}}, {"scene", 0}};
  Json roots = Json::array();
  json["nodes"] = Json::array();
  for (std::size_t i = 0; i < model.instances.size(); ++i) {
    json["nodes"].push_back(fresh_node(model, i));
    roots.push_back(i);
  }
  const Mat4d transform = world_to_gltf(model);
  if (!transform.is_identity()) add_root(transform, json, roots);
  json["scenes"] = Json::array({{{"nodes", std::move(roots)}}});
  json["meshes"] = Json::array();
  for (const Mesh& mesh : model.meshes) json["meshes"].push_back(fresh_mesh(mesh, model.materials.size()));
  return json;
}

namespace {

// The textures of a document, each image once.
class FreshTextures {
 public:
  FreshTextures(Json& json, GltfPack& pack) : json_(json), pack_(pack) {}

  // {"index": …}; null for an image that is missing or of a kind that glTF doesn't hold.
  Json info(const Image* image) {
    if (image == nullptr || image->encoded.empty() || (image->mime != "image/png" && image->mime != "image/jpeg")) {
      return nullptr;
    }
    const auto [known, is_new] = textures_.emplace(image, textures_.size());
    if (is_new) {
      const std::string_view bytes(reinterpret_cast<const char*>(image->encoded.data()), image->encoded.size());
      json_["images"].push_back({{"bufferView", pack_.add_bytes(0, bytes)}, {"mimeType", image->mime}});
      if (!image->name.empty()) json_["images"].back()["name"] = image->name;
      json_["textures"].push_back({{"source", known->second}});
    }
    return {{"index", known->second}};
  }

 private:
  Json& json_;
  GltfPack& pack_;
  std::map<const Image*, std::size_t> textures_;
};

}  // namespace

void add_fresh_materials(const Model& model, Json& json, GltfPack& pack, std::vector<std::string>& warnings) {
  std::vector<std::string> left_out;
  FreshTextures textures(json, pack);
  for (const Material& material : model.materials) {
    Json out = Json::object();
    if (!material.name.empty()) out["name"] = material.name;
    Json pbr = {{"baseColorFactor", material.base_color},
                {"metallicFactor", material.metallic},
                {"roughnessFactor", material.roughness}};
    if (Json info = textures.info(material.base_color_texture.get()); !info.is_null()) {
      pbr["baseColorTexture"] = std::move(info);
    }
    out["pbrMetallicRoughness"] = std::move(pbr);
    const MtlLook look = look_of(material, left_out);
    const Image* normal = look.normal_texture != nullptr ? look.normal_texture : material.normal_texture.get();
    if (Json info = textures.info(normal); !info.is_null()) {
      if (look.normal_scale != 1) info["scale"] = look.normal_scale;
      out["normalTexture"] = std::move(info);
    }
    if (Json info = textures.info(look.emissive_texture); !info.is_null()) out["emissiveTexture"] = std::move(info);
    if (look.emissive != std::array<float, 3>{0, 0, 0}) out["emissiveFactor"] = look.emissive;
    if (material.double_sided) out["doubleSided"] = true;
    if (material.alpha_cutoff > 0) {
      out["alphaMode"] = "MASK";
      out["alphaCutoff"] = material.alpha_cutoff;
    } else if (material.blend || material.base_color[3] < 1) {
      out["alphaMode"] = "BLEND";
    }
    json["materials"].push_back(std::move(out));
  }
  if (!left_out.empty()) {
    warnings.push_back(fmt::format("properties of materials were left out: {}", fmt::join(left_out, ", ")));
  }
}

void use_untextured_material(Json& json, Json& primitive) {
  if (!primitive.contains("material") || primitive["attributes"].contains("TEXCOORD_0")) return;
  Json twin = json["materials"][primitive["material"].get<std::size_t>()];
  if (twin["pbrMetallicRoughness"].erase("baseColorTexture") + twin.erase("normalTexture") +
          twin.erase("emissiveTexture") ==
      0)
    return;
  Json& materials = json["materials"];
  auto found = std::find(materials.begin(), materials.end(), twin);
  if (found == materials.end()) {
    materials.push_back(twin);
    found = std::prev(materials.end());
  }
  primitive["material"] = static_cast<std::size_t>(found - materials.begin());
}

}  // namespace lodestone::io
