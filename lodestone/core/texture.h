// Looking up textures.
#pragma once

#include "lodestone/core/material.h"
#include "lodestone/core/pixels.h"
#include "lodestone/math/vec.h"

namespace lodestone {

/// After the material's affine map.
Vec2d mapped(Vec2d uv, const TextureCoordinates& coordinates);

/// RGB as light in [0, 1], bilinear between the centres of the four pixels around (u, v); (0, 0) is the top left corner
/// and the image repeats. A pixel of an empty image and a (u, v) that is not finite are white.
Vec3d texture_light(const Pixels& pixels, Vec2d uv);

}  // namespace lodestone
