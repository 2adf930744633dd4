#include "app/options/bake_run.h"

#include <fmt/format.h>

#include <memory>
#include <optional>
#include <utility>

#include "lodestone/bake/atlas.h"
#include "lodestone/bake/bake.h"
#include "lodestone/bake/transfer.h"
#include "lodestone/io/images/decode.h"
#include "lodestone/io/images/encode.h"

namespace lodestone::app {

OptionGroup baked_group() {
  return {"What comes over from the input",
          {{"--texture-size",
            "",
            "N",
            "",
            "texels",
            "make an atlas, and bake base colour and normal map of the input into textures of N x N (16 to 16,384; "
            "without: normals and colours of vertices)",
            {},
            Completion::none},
           {"--no-attributes", "", "", "", "", "positions alone", {}, Completion::none}}};
}

Result<BakePlan> bake_plan(const Arguments& arguments) {
  BakePlan plan;
  plan.attributes = !arguments.has("--no-attributes");
  if (!arguments.has("--texture-size")) return plan;
  if (!plan.attributes) {
    return fail(ErrorCode::bad_argument, "--texture-size and --no-attributes can't be given together", {},
                "choose one");
  }
  const Result<std::uint64_t> size = arguments.count("--texture-size", 16, 16'384);
  if (!size) return fail(size.error());
  plan.texture_size = static_cast<std::uint32_t>(*size);
  return plan;
}

struct AttributeSource::Data {
  Model model;  // BakeSource looks into it
  BakePlan plan;
  bool has_normals = false;
  std::optional<bake::BakeSource> source;
};

Result<AttributeSource> AttributeSource::create(const Model& model, const BakePlan& plan,
                                                std::vector<std::string>& warnings, const Task& task) {
  AttributeSource out;
  const auto data = std::make_shared<Data>();
  data->plan = plan;
  out.data_ = data;
  if (!plan.attributes) return out;
  for (const Mesh& mesh : model.meshes) {
    data->has_normals = data->has_normals || find_stream(mesh, Semantic::normal) != nullptr;
  }
  data->model = model;
  if (const Result<void> decoded = io::decode_base_colors(data->model, warnings, task); !decoded) {
    return fail(decoded.error());
  }
  Result<bake::BakeSource> source = bake::BakeSource::create(data->model, task);
  if (!source) return fail(source.error());
  // Nothing to take over: the surface stays as it is.
  if (plan.texture_size > 0 || data->has_normals || source->has_color()) data->source = std::move(*source);
  return out;
}

namespace {

Result<void> add_textures(Model& surface, const bake::BakeSource& source, std::uint32_t size, std::size_t level,
                          const Task& task) {
  Mesh& mesh = surface.meshes.front();
  bake::AtlasOptions atlas_options;
  atlas_options.texture_size = size;
  const Result<bake::Atlas> atlas = bake::make_atlas(mesh, atlas_options, task.part(0.4));
  if (!atlas) return fail(atlas.error());
  bake::BakeOptions options;
  options.texture_size = size;
  Result<bake::Baked> baked = bake::bake_textures(atlas->mesh, source, options, task.part(0.6));
  if (!baked) return fail(baked.error());
  Material material;
  material.name = "baked";
  if (!baked->base_color.rgba.empty()) {
    const auto image = io::png_image(baked->base_color, fmt::format("base_color_{}", level));
    if (!image) return fail(image.error());
    material.base_color_texture = *image;
    material.base_color_pixels = std::make_shared<Pixels>(std::move(baked->base_color));
  }
  if (!baked->normal_map.rgba.empty()) {
    const auto image = io::png_image(baked->normal_map, fmt::format("normal_{}", level));
    if (!image) return fail(image.error());
    material.normal_texture = *image;
  }
  mesh = std::move(baked->mesh);
  mesh.groups = {{0, mesh.name}};
  surface.materials = {std::move(material)};
  surface.uv_origin_top = true;
  return {};
}

}  // namespace

Result<void> AttributeSource::add_to(Model& surface, std::size_t level, const Task& task) const {
  if (!data_->source) return {};
  if (data_->plan.texture_size > 0) return add_textures(surface, *data_->source, data_->plan.texture_size, level, task);
  bake::TransferOptions options;
  options.normals = data_->has_normals;
  Result<Mesh> made = bake::transfer_attributes(surface.meshes.front(), *data_->source, options, task);
  if (!made) return fail(made.error());
  surface.meshes.front() = std::move(*made);
  return {};
}

}  // namespace lodestone::app
