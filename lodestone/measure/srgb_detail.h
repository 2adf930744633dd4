// Colours as they are compared: in sRGB, which is nearer to what eyes see than light is.
#pragma once

#include "lodestone/math/vec.h"

namespace lodestone::measure::detail {

/// Light to sRGB (IEC 61966-2-1), each channel cut to [0, 1]. Uses pow: for figures that are read, not for bytes.
Vec3d to_srgb(Vec3d light);

}  // namespace lodestone::measure::detail
