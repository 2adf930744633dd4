// Colours for numbers.
#pragma once

#include "lodestone/math/vec.h"

namespace lodestone::render {

/// Dark violet over blue and green to yellow for `share` from 0 to 1 (cut to it): even steps look even, in grey and to
/// the colour-blind too. sRGB, 0 to 1. The map is viridis of matplotlib (S. van der Walt and N. Smith, 2015, CC0): ten
/// of its colours, with straight lines between.
Vec3f heat_color(float share);

/// The same colour as light (linear), to the nearest of sRGB's 256 steps a channel.
Vec3f heat_light(float share);

}  // namespace lodestone::render
