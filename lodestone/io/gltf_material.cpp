// Materials of a glTF document, as far as drawing and other formats need them; writing glTF uses the document itself.
#include <algorithm>
#include <array>

#include "lodestone/io/gltf_detail.h"

namespace lodestone::io {

namespace {

// The element of `array` that the member `key` of `object` names, and its index; null if there is none.
struct Named {
  const Json* json = nullptr;
  std::size_t index = 0;
};

Named named_element(const Json& object, const char* key, const Json& array) {
  const Json* value = member(object, key);
  if (value == nullptr) return {};
  const std::uint64_t index = as_uint(*value).value_or(array.size());
  if (index >= array.size()) return {};
  return {&array[static_cast<std::size_t>(index)], static_cast<std::size_t>(index)};
}

std::shared_ptr<const Image> read_texture(const Document::Data& data, const Json& info) {
  const Named texture = named_element(info, "index", array_member(data.json, "textures"));
  if (texture.json == nullptr) return nullptr;
  const Named image = named_element(*texture.json, "source", array_member(data.json, "images"));
  if (image.json == nullptr) return nullptr;
  const ImageBytes bytes = image_bytes(data, image.index);
  auto out = std::make_shared<Image>();
  const Json& json = *image.json;
  out->name = string_member(json, "name");
  if (out->name.empty() && !string_member(json, "uri").starts_with("data:")) out->name = string_member(json, "uri");
  out->mime = bytes.mime;
  const auto raw = std::as_bytes(std::span(bytes.bytes));
  out->encoded.assign(raw.begin(), raw.end());
  return out;
}

Material read_material(const Document::Data& data, const Json& json) {
  Material material;
  material.name = string_member(json, "name");
  const Json* sided = member(json, "doubleSided");
  material.double_sided = sided != nullptr && sided->is_boolean() && sided->get<bool>();
  material.metallic = 1;
  const Json* pbr = member(json, "pbrMetallicRoughness");
  if (pbr == nullptr) return material;
  std::array<double, 4> color{1, 1, 1, 1};
  if (const auto ok = numbers_member(*pbr, "baseColorFactor", color, ""); ok && *ok) {
    for (std::size_t i = 0; i < 4; ++i) material.base_color[i] = static_cast<float>(color[i]);
  }
  const auto number = [&](const char* key, float fallback) {
    const Json* value = member(*pbr, key);
    return value != nullptr && value->is_number() ? value->get<float>() : fallback;
  };
  material.metallic = number("metallicFactor", 1);
  material.roughness = number("roughnessFactor", 1);
  if (const Json* texture = member(*pbr, "baseColorTexture"); texture != nullptr) {
    material.base_color_texture = read_texture(data, *texture);
  }
  return material;
}

}  // namespace

std::vector<Material> read_materials(const Document::Data& data) {
  std::vector<Material> materials;
  for (const Json& json : array_member(data.json, "materials")) materials.push_back(read_material(data, json));
  return materials;
}

}  // namespace lodestone::io
