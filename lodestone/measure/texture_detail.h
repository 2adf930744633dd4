// Looking up textures, and the two ways of writing a colour: as light, and as sRGB stores and screens take it.
#pragma once

#include "lodestone/core/material.h"
#include "lodestone/core/pixels.h"
#include "lodestone/math/vec.h"

namespace lodestone::measure::detail {

/// After the material's affine map.
Vec2d mapped(Vec2d uv, const TextureCoordinates& coordinates);

/// RGB as light in [0, 1], bilinear between the centres of the four pixels around (u, v); (0, 0) is the top left corner
/// and the image repeats. A pixel of an empty image and a (u, v) that is not finite are white.
Vec3d texture_light(const Pixels& pixels, Vec2d uv);

/// Light to sRGB (IEC 61966-2-1), each channel cut to [0, 1]. Uses pow: for figures that are read, not for bytes.
Vec3d to_srgb(Vec3d light);

}  // namespace lodestone::measure::detail
