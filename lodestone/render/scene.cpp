#include "lodestone/render/scene.h"

#include <algorithm>
#include <map>

#include "lodestone/render/corner_streams_detail.h"
#include "lodestone/render/scene_detail.h"

namespace lodestone::render {

namespace {

using detail::Appearance;
using detail::SceneData;

void find_bounds(SceneData& data) {
  for (const Vec3d& p : data.surface.positions) {
    if (is_finite(p)) data.bounds.add(p);
  }
}

void number_instances(const Model& model, SceneData& data) {
  data.first_drawn.push_back(0);
  for (const Instance& instance : model.instances) {
    data.first_drawn.push_back(data.first_drawn.back() +
                               static_cast<std::uint32_t>(model.meshes[instance.mesh].triangles.size()));
  }
}

void make_appearances(const Model& model, SceneData& data) {
  std::map<const Pixels*, const detail::MipTexture*> made;
  for (const Material& material : model.materials) {
    Appearance appearance;
    appearance.color = {material.base_color[0], material.base_color[1], material.base_color[2]};
    appearance.alpha = material.base_color[3];
    appearance.alpha_cutoff = material.alpha_cutoff;
    appearance.double_sided = material.double_sided;
    const auto& pixels = material.base_color_pixels;
    if (pixels != nullptr && pixels->width > 0 && pixels->height > 0) {
      const detail::MipTexture*& texture = made[pixels.get()];
      if (texture == nullptr) {
        data.textures.push_back(std::make_unique<const detail::MipTexture>(pixels));
        texture = data.textures.back().get();
      }
      appearance.texture = texture;
    } else {
      appearance.missing = material.base_color_texture != nullptr;
    }
    data.appearances.push_back(appearance);
  }
  data.appearances.emplace_back();
  data.masked = std::any_of(data.appearances.begin(), data.appearances.end(),
                            [](const Appearance& l) { return l.alpha_cutoff > 0; });
}

}  // namespace

Result<Scene> Scene::create(const Model& model, const SceneOptions& options, Task task) {
  Result<spatial::Surface> surface = spatial::flatten(model, options.input, task.part(0.4));
  LODESTONE_TRY(surface);
  auto data = std::make_shared<SceneData>();
  data->surface = std::move(*surface);
  find_bounds(*data);
  if (data->bounds.empty()) return fail(ErrorCode::empty, "no position of the model is finite");
  number_instances(model, *data);
  make_appearances(model, *data);
  LODESTONE_TRY(detail::gather_corners(model, options, *data, task.part(0.6)));
  if (task.cancelled()) return cancelled_error("preparing the scene");
  Scene scene;
  scene.data_ = std::move(data);
  return scene;
}

const Box3d& Scene::bounds() const { return data_->bounds; }
std::size_t Scene::triangle_count() const { return data_->surface.triangles.size(); }
bool Scene::has_textures() const { return !data_->uvs.empty(); }
bool Scene::has_colors() const { return !data_->colors.empty(); }
bool Scene::has_values() const { return !data_->values.empty(); }
double Scene::least_value() const { return static_cast<double>(data_->least_value); }
double Scene::largest_value() const { return static_cast<double>(data_->largest_value); }
const std::vector<std::string>& Scene::notes() const { return data_->notes; }

Camera Scene::framed(const ViewAngles& angles, double aspect, const Lens& lens, Vec3d up) const {
  return frame_points(data_->surface.positions, angles, aspect, lens, up);
}

std::uint32_t Scene::instance_of(std::uint32_t drawn_triangle) const {
  const auto& first = data_->first_drawn;
  return static_cast<std::uint32_t>(std::upper_bound(first.begin(), first.end(), drawn_triangle) - first.begin() - 1);
}

}  // namespace lodestone::render
