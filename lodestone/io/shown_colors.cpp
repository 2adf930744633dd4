#include "lodestone/io/shown_colors_detail.h"

#include <algorithm>

#include "lodestone/core/srgb.h"

namespace lodestone::io {

namespace {

bool is_light(const AttributeStream& stream) { return stream.is_light; }

void show(AttributeStream& stream) {
  auto& values = std::get<std::vector<float>>(stream.values);  // only streams of floats are made as light
  for (std::size_t i = 0; i < values.size(); ++i) {
    const bool is_alpha = i % stream.components == 3;
    if (!is_alpha) values[i] = static_cast<float>(byte_of_light(static_cast<double>(values[i]))) / 255.0F;
  }
  stream.type = ComponentType::uint8;
  stream.normalized = true;
  stream.is_light = false;
}

}  // namespace

bool has_light_colors(const Model& model) {
  return std::any_of(model.meshes.begin(), model.meshes.end(), [](const Mesh& mesh) {
    return std::any_of(mesh.attributes.begin(), mesh.attributes.end(), is_light);
  });
}

Model with_shown_colors(Model model) {
  for (Mesh& mesh : model.meshes) {
    for (AttributeStream& stream : mesh.attributes) {
      if (is_light(stream)) show(stream);
    }
  }
  return model;
}

}  // namespace lodestone::io
