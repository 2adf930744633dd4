// Textures with ever smaller copies of themselves, so that small pictures of large textures don't glitter.
#pragma once

#include <memory>
#include <vector>

#include "lodestone/core/pixels.h"
#include "lodestone/math/vec.h"

namespace lodestone::render::detail {

struct Texel {
  Vec3f light;
  float alpha = 1;
};

class MipTexture {
 public:
  /// `pixels` must have at least one.
  explicit MipTexture(std::shared_ptr<const Pixels> pixels);

  /// At (u, v), origin top left, repeating. (du_dx, dv_dx) and (du_dy, dv_dy): how (u, v) changes from one pixel of the
  /// picture to the next, which chooses the copies that are blended. Coordinates that are not finite give the first
  /// pixel.
  Texel sample(Vec2f uv, Vec2f per_x, Vec2f per_y) const;

 private:
  Texel bilinear(const Pixels& level, Vec2f uv) const;
  std::shared_ptr<const Pixels> full_;
  std::vector<Pixels> smaller_;  // each half as wide and high as the one before
};

}  // namespace lodestone::render::detail
