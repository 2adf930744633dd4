#include "lodestone/render/render.h"

#include <algorithm>

#include "lodestone/render/legend_detail.h"
#include "lodestone/render/raster_detail.h"
#include "lodestone/render/shade_detail.h"
#include "lodestone/render/tone_detail.h"

namespace lodestone::render {

namespace {

using detail::kTile;
using detail::SampleTile;

// Mixes the samples of a pixel.
class Resolver {
 public:
  Resolver(const detail::Raster& raster, const detail::Shader& shader, const std::array<std::uint8_t, 4>& background)
      : pattern_(raster.pattern()), shader_(shader), background_(background) {
    const detail::Tone& tone = detail::Tone::get();
    background_light_ = tone.light(background[0], background[1], background[2]);
    background_alpha_ = static_cast<float>(background[3]) / 255;
  }

  std::array<std::uint8_t, 4> pixel(const std::uint32_t* ids, std::uint32_t x, std::uint32_t y) const {
    const auto samples = static_cast<std::size_t>(pattern_.count);
    Vec3f light{};
    float alpha = 0;
    std::uint32_t done = 0;  // a bit a sample
    for (std::size_t s = 0; s < samples; ++s) {
      if ((done >> s & 1) != 0) continue;
      // All samples that see the same triangle get its colour at their middle.
      std::int32_t sum_x = 0, sum_y = 0, count = 0;
      for (std::size_t other = s; other < samples; ++other) {
        if (ids[other] != ids[s]) continue;
        done |= 1U << other;
        sum_x += pattern_.x[other];
        sum_y += pattern_.y[other];
        ++count;
      }
      const auto share = static_cast<float>(count);
      if (ids[s] == kNone) {
        if (count == pattern_.count) return background_;
        light += background_light_ * (background_alpha_ * share);
        alpha += background_alpha_ * share;
        continue;
      }
      const float per_sample = 1 / (share * detail::kSub);
      const Vec2f at{static_cast<float>(x) + static_cast<float>(sum_x) * per_sample,
                     static_cast<float>(y) + static_cast<float>(sum_y) * per_sample};
      light += shader_.color(ids[s], at) * share;
      alpha += share;
    }
    const detail::Tone& tone = detail::Tone::get();
    light = light * (1 / alpha);
    const float coverage = alpha / static_cast<float>(samples);
    return {tone.byte(light.x), tone.byte(light.y), tone.byte(light.z),
            static_cast<std::uint8_t>(coverage * 255 + 0.5F)};
  }

 private:
  const detail::SamplePattern& pattern_;
  const detail::Shader& shader_;
  std::array<std::uint8_t, 4> background_;
  Vec3f background_light_;
  float background_alpha_;
};

}  // namespace

Result<Pixels> render(const Scene& scene, const Camera& camera, const RenderOptions& options, Task task) {
  LODESTONE_TRY(detail::check_view(camera, options.width, options.height, options.samples));
  if (options.shading == Shading::heat && !scene.has_values()) {
    return fail(ErrorCode::bad_argument, "a heat map needs values, and the scene has none", {},
                "give them or name an attribute that holds them");
  }
  const HeatRange range = options.heat_range.value_or(default_heat_range(scene));
  const detail::Raster raster(scene.data(), camera, options.width, options.height, options.samples, task);
  const detail::Shader shader(raster, options, range);
  const Resolver resolver(raster, shader, options.background);
  Pixels pixels;
  pixels.width = options.width;
  pixels.height = options.height;
  pixels.rgba.resize(std::size_t{options.width} * options.height * 4);
  raster.for_each_tile(task, [&](const SampleTile& tile, std::uint32_t x0, std::uint32_t y0) {
    for (std::uint32_t y = y0; y < std::min<std::uint32_t>(y0 + kTile, options.height); ++y) {
      std::uint8_t* out = pixels.rgba.data() + (std::size_t{y} * options.width + x0) * 4;
      for (std::uint32_t x = x0; x < std::min<std::uint32_t>(x0 + kTile, options.width); ++x, out += 4) {
        const std::size_t first = SampleTile::first_sample(static_cast<std::int32_t>(x - x0),
                                                           static_cast<std::int32_t>(y - y0), options.samples);
        const std::array<std::uint8_t, 4> color = resolver.pixel(&tile.id[first], x, y);
        std::copy(color.begin(), color.end(), out);
      }
    }
  });
  if (task.cancelled()) return cancelled_error("drawing");
  if (options.shading == Shading::heat && options.legend) detail::draw_legend(pixels, range, options.unit);
  return pixels;
}

Result<Pixels> render(const Model& model, const Camera& camera, const RenderOptions& options, Task task) {
  const Result<Scene> scene = Scene::create(model, {}, task.part(0.5));
  LODESTONE_TRY(scene);
  return render(*scene, camera, options, task.part(0.5));
}

Shading default_shading(const Scene& scene) {
  return scene.has_textures() ? Shading::textured : scene.has_colors() ? Shading::vertex_color : Shading::smooth;
}

HeatRange default_heat_range(const Scene& scene) {
  const double least = scene.least_value(), largest = scene.largest_value();
  // Errors and distances begin at 0; a scale that begins at 0.0013 is harder to read.
  return {least > 0 && least < 0.2 * largest ? 0 : least, largest};
}

}  // namespace lodestone::render
