// Materials of a glTF document, as far as drawing and other formats need them; writing glTF uses the document itself.
#include <algorithm>
#include <array>

#include "lodestone/io/gltf/gltf_detail.h"
#include "lodestone/math/angle.h"

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

// The object of an extension, or null.
const Json* extension_of(const Json& object, const char* name) {
  const Json* all = member(object, "extensions");
  return all != nullptr ? member(*all, name) : nullptr;
}

std::shared_ptr<const Image> read_texture(const Document::Data& data, const Json& info) {
  const Named texture = named_element(info, "index", array_member(data.json, "textures"));
  if (texture.json == nullptr) return nullptr;
  const Json& images = array_member(data.json, "images");
  Named image = named_element(*texture.json, "source", images);
  if (image.json == nullptr) {
    if (const Json* webp = extension_of(*texture.json, "EXT_texture_webp"); webp != nullptr) {
      image = named_element(*webp, "source", images);
    }
  }
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

TextureCoordinates read_coordinates(const Json& info) {
  TextureCoordinates out;
  const auto set_of = [&](const Json& json) {
    if (const Json* value = member(json, "texCoord"); value != nullptr) {
      out.set = static_cast<std::uint32_t>(std::min<std::uint64_t>(as_uint(*value).value_or(0), 0xFFFF));
    }
  };
  set_of(info);
  const Json* transform = extension_of(info, "KHR_texture_transform");
  if (transform == nullptr) return out;
  set_of(*transform);
  std::array<double, 2> offset{0, 0}, scale{1, 1};
  if (!numbers_member(*transform, "offset", offset, "")) offset = {0, 0};
  if (!numbers_member(*transform, "scale", scale, "")) scale = {1, 1};
  double cosine = 1, sine = 0;
  if (const Json* angle = member(*transform, "rotation"); angle != nullptr && angle->is_number()) {
    constexpr double kDegrees = 180 / 3.14159265358979323846;
    const SinCos turn = sin_cos_degrees(angle->get<double>() * kDegrees);
    cosine = turn.cos;
    sine = turn.sin;
  }
  out.map = {scale[0] * cosine, scale[1] * sine, offset[0], -scale[0] * sine, scale[1] * cosine, offset[1]};
  return out;
}

Material read_material(const Document::Data& data, const Json& json) {
  Material material;
  material.name = string_member(json, "name");
  const Json* sided = member(json, "doubleSided");
  material.double_sided = sided != nullptr && sided->is_boolean() && sided->get<bool>();
  if (string_member(json, "alphaMode") == "MASK") {
    const Json* cutoff = member(json, "alphaCutoff");
    material.alpha_cutoff = cutoff != nullptr && cutoff->is_number() ? cutoff->get<float>() : 0.5F;
  }
  material.blend = string_member(json, "alphaMode") == "BLEND";
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
    material.base_color_coordinates = read_coordinates(*texture);
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
