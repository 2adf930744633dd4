// Colours for formats whose colours are what a screen shows.
#pragma once

#include "lodestone/core/model.h"

namespace lodestone::io {

/// True where with_shown_colors() has something to do.
bool has_light_colors(const Model& model);

/// The model with all colours that are light (AttributeStream::is_light) as sRGB bytes, which is what programs take the
/// colours of PLY, OBJ and OFF for. O(model).
Model with_shown_colors(Model model);

}  // namespace lodestone::io
