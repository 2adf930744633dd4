#include "lodestone/report/level_pictures.h"

#include "lodestone/core/validate.h"
#include "lodestone/io/images/encode.h"
#include "lodestone/measure/heat.h"
#include "lodestone/render/render.h"

namespace lodestone::report {

namespace {

Result<std::string> draw(const render::Scene& scene, const Camera& camera, const render::RenderOptions& options,
                         const Task& task) {
  const Result<Pixels> picture = render::render(scene, camera, options, task);
  LODESTONE_TRY(picture);
  return io::preview_webp(*picture);
}

Result<std::string> draw_heat(const Model& original, const Model& level, const Camera& camera,
                              render::RenderOptions options, double& range, const Task& task) {
  measure::HeatOptions coarse;
  coarse.tolerance = 0.05;
  coarse.input = Input::valid;
  coarse.shortest_side = 0.005;  // three pixels or so
  const Result<measure::Heat> heat = measure::heat_map(original, level, coarse, task.part(0.7));
  LODESTONE_TRY(heat);
  range = heat->range;
  render::SceneOptions values;
  values.attribute = "_ERROR";
  values.input = Input::valid;
  const Result<render::Scene> scene = render::Scene::create(heat->model, values, task.part(0.2));
  LODESTONE_TRY(scene);
  options.shading = render::Shading::heat;
  options.legend = false;  // the page has one
  options.heat_range = render::HeatRange{0, range > 0 ? range : 1};
  return draw(*scene, camera, options, task.part(0.1));
}

}  // namespace

Result<std::vector<LevelPictures>> draw_levels(const Ladder& ladder, const PictureOptions& options, Task task) {
  LODESTONE_TRY(validate(ladder, task));
  std::vector<LevelPictures> out(ladder.levels.size());
  render::RenderOptions look;
  look.width = options.width;
  look.height = options.height;
  const double share = 1.0 / static_cast<double>(ladder.levels.size());
  render::SceneOptions of_valid;
  of_valid.input = Input::valid;
  Camera camera;
  for (std::size_t i = 0; i < ladder.levels.size(); ++i) {
    const Task part = task.part(0.4 * share);
    const Result<render::Scene> scene = render::Scene::create(ladder.model(i), of_valid, part.part(0.5));
    LODESTONE_TRY(scene);
    if (i == 0) camera = scene->framed(options.angles, static_cast<double>(look.width) / look.height, {}, options.up);
    look.shading = render::default_shading(*scene);
    look.wireframe = false;
    Result<std::string> shaded = draw(*scene, camera, look, part.part(0.2));
    LODESTONE_TRY(shaded);
    look.shading = render::Shading::flat;
    look.wireframe = true;
    Result<std::string> wireframe = draw(*scene, camera, look, part.part(0.3));
    LODESTONE_TRY(wireframe);
    out[i].shaded = std::move(*shaded);
    out[i].wireframe = std::move(*wireframe);
    if (i == 0) continue;
    look.wireframe = false;
    Result<std::string> heat =
        draw_heat(ladder.original, ladder.model(i), camera, look, out[i].heat_range, task.part(0.6 * share));
    LODESTONE_TRY(heat);
    out[i].heat = std::move(*heat);
  }
  return out;
}

}  // namespace lodestone::report
