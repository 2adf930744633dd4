#include "lodestone/chain/voxels/surface_attributes.h"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "lodestone/bake/atlas.h"
#include "lodestone/bake/bake.h"
#include "lodestone/bake/transfer.h"
#include "lodestone/core/attributes.h"

namespace lodestone::chain {

struct AttributeSource::Data {
  Model model;  // BakeSource looks into it
  SurfaceAttributeOptions options;
  bool has_normals = false;
  std::optional<bake::BakeSource> source;
};

Result<AttributeSource> AttributeSource::create(const Model& model, const SurfaceAttributeOptions& options, Task task) {
  if (options.texture_size > 0 && !options.encode) {
    return fail(ErrorCode::bad_argument, "textures are asked for, but there is no encoder of images", {},
                "give one, such as io::png_image");
  }
  AttributeSource out;
  const auto data = std::make_shared<Data>();
  data->options = options;
  out.data_ = data;
  if (!options.attributes) return out;
  for (const Mesh& mesh : model.meshes) {
    data->has_normals = data->has_normals || find_stream(mesh, Semantic::normal) != nullptr;
  }
  data->model = model;
  Result<bake::BakeSource> source = bake::BakeSource::create(data->model, task);
  LODESTONE_TRY(source);
  // Nothing to take over: the surface stays as it is.
  if (options.texture_size > 0 || data->has_normals || source->has_color()) data->source = std::move(*source);
  return out;
}

namespace {

Result<void> add_textures(Model& surface, const bake::BakeSource& source, const SurfaceAttributeOptions& take,
                          std::size_t level, const Task& task) {
  Mesh& mesh = surface.meshes.front();
  bake::AtlasOptions atlas_options;
  atlas_options.texture_size = take.texture_size;
  const Result<bake::Atlas> atlas = bake::make_atlas(mesh, atlas_options, task.part(0.4));
  LODESTONE_TRY(atlas);
  bake::BakeOptions options;
  options.texture_size = take.texture_size;
  Result<bake::Baked> baked = bake::bake_textures(atlas->mesh, source, options, task.part(0.6));
  LODESTONE_TRY(baked);
  Material material;
  material.name = "baked";
  if (!baked->base_color.rgba.empty()) {
    const auto image = take.encode(baked->base_color, fmt::format("base_color_{}", level));
    LODESTONE_TRY(image);
    material.base_color_texture = *image;
    material.base_color_pixels = std::make_shared<Pixels>(std::move(baked->base_color));
  }
  if (!baked->normal_map.rgba.empty()) {
    const auto image = take.encode(baked->normal_map, fmt::format("normal_{}", level));
    LODESTONE_TRY(image);
    material.normal_texture = *image;
  }
  mesh = std::move(baked->mesh);
  mesh.groups = {{0, mesh.name}};
  surface.materials = {std::move(material)};
  surface.uv_origin_top = true;
  return {};
}

}  // namespace

Result<void> AttributeSource::add_to(Model& surface, std::size_t level, Task task) const {
  if (!data_->source) return {};
  if (data_->options.texture_size > 0) return add_textures(surface, *data_->source, data_->options, level, task);
  bake::TransferOptions options;
  options.normals = data_->has_normals;
  Result<Mesh> made = bake::transfer_attributes(surface.meshes.front(), *data_->source, options, task);
  LODESTONE_TRY(made);
  surface.meshes.front() = std::move(*made);
  return {};
}

}  // namespace lodestone::chain
