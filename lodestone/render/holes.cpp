#include "lodestone/render/holes_detail.h"

#include "lodestone/render/fragment_detail.h"

namespace lodestone::render::detail {

bool Holes::at(std::uint32_t id, Vec2f at) const {
  const SceneData& scene = raster_.scene();
  const Appearance& appearance = scene.appearance_of(id);
  const Fragment fragment = fragment_at(raster_, id, at);
  float alpha = appearance.alpha;
  if (!scene.colors.empty()) {
    const Corners<PackedColor>& c = scene.colors[id];
    const auto of = [](const PackedColor& color) { return static_cast<float>(color[3]) * (1.0F / 65535); };
    alpha *= fragment.mix(of(c[0]), of(c[1]), of(c[2]));
  }
  if (appearance.texture != nullptr && !scene.uvs.empty()) {
    const Corners<Vec2f>& uv = scene.uvs[id];
    const Vec2f here{fragment.mix(uv[0].x, uv[1].x, uv[2].x), fragment.mix(uv[0].y, uv[1].y, uv[2].y)};
    // At full size: the mean alpha of a leaf's smaller copies falls below the cutoff, and trees would go bald.
    alpha *= appearance.texture->sample(here, {0, 0}, {0, 0}).alpha;
  }
  return alpha < appearance.alpha_cutoff;
}

}  // namespace lodestone::render::detail
