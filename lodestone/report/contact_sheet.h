// Contact sheets: all levels of a ladder in one picture.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/pixels.h"
#include "lodestone/math/camera.h"
#include "lodestone/measure/screen.h"
#include "lodestone/render/render.h"

namespace lodestone::report {

struct SheetLevel {
  render::Scene scene;
  double error = 0;  ///< distance to the original, model units
};

struct SheetOptions {
  render::RenderOptions picture;  ///< of one level; width and height are those of its cell
  ViewAngles angles{20, 15};
  Lens lens;  ///< of the upper row; its vertical field of view is that of `view`, too
  Vec3d up{0, 1, 0};
  measure::View view;  ///< the screen that the lower row is taken from
  double pixels = 1;   ///< that an error may cover where its level takes over
  std::string unit;    ///< of lengths; empty: none is told
};

/// Pixels of the whole sheet for so many levels.
struct SheetSize {
  std::uint32_t width = 0, height = 0;
};
SheetSize sheet_size(std::size_t levels, const SheetOptions& options);

/// A column a level, levels[0] the original. Above: all from one camera, which frames the original. Below: each from
/// the distance where it takes over (its error covers `pixels` there), as large as the screen of `view` shows it then,
/// reduced where that would not fit into the cell; the original from the first level's. Captions tell triangles, error,
/// distance and size. Errors: bad_argument (no level, sides above render::kMostSide, heat), cancelled.
Result<Pixels> contact_sheet(const std::vector<SheetLevel>& levels, const SheetOptions& options, Task task = {});

}  // namespace lodestone::report
