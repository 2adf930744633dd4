// The colour of a point of a triangle, as light.
#pragma once

#include "lodestone/math/vec.h"
#include "lodestone/render/fragment_detail.h"
#include "lodestone/render/raster_detail.h"
#include "lodestone/render/render.h"

namespace lodestone::render::detail {

class Shader {
 public:
  /// All three must outlive it.
  Shader(const Raster& raster, const RenderOptions& options, const HeatRange& range);

  /// Of triangle `id` at (x, y) pixels of the picture.
  Vec3f color(std::uint32_t id, Vec2f at) const;

 private:
  Vec3f normal_at(std::uint32_t id, const Fragment& fragment, bool of_face) const;
  Vec3f base_color(std::uint32_t id, Vec2f at, const Fragment& fragment) const;
  Vec3f texture_color(std::uint32_t id, Vec2f at, const Fragment& fragment, const Appearance& appearance) const;
  Vec3f vertex_color(std::uint32_t id, const Fragment& fragment) const;
  Vec3f heat_color(std::uint32_t id, const Fragment& fragment) const;
  float brightness(Vec3f normal) const;
  Vec3f with_wires(std::uint32_t id, Vec2f at, Vec3f color) const;

  const Raster& raster_;
  const SceneData& scene_;
  const RenderOptions& options_;
  float heat_least_, heat_per_unit_;
  Vec3f key_, sky_, eye_;  // directions to them
};

}  // namespace lodestone::render::detail
