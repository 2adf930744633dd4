// What the colours of a heat map mean, drawn into the picture.
#pragma once

#include <string>

#include "lodestone/core/pixels.h"
#include "lodestone/render/render.h"

namespace lodestone::render::detail {

/// A bar of the colours with five values beside it and the unit below, in the lower right corner. Pictures too small
/// for it stay as they are.
void draw_legend(Pixels& pixels, const HeatRange& range, const std::string& unit);

}  // namespace lodestone::render::detail
