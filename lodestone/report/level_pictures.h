// Pictures of all levels of a ladder from one camera, for a page.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/level.h"
#include "lodestone/math/camera.h"

namespace lodestone::report {

struct PictureOptions {
  std::uint32_t width = 640, height = 480;  ///< pixels
  ViewAngles angles{20, 15};
  Vec3d up{0, 1, 0};
};

/// WebP files.
struct LevelPictures {
  std::string shaded;     ///< with textures or vertex colours where there are some
  std::string wireframe;  ///< grey, with the triangles' sides
  std::string heat;       ///< the original's surface by its distance to this level; empty for the original
  double heat_range = 0;  ///< distance of heat's last colour, as Heat::range; model units
};

/// Drawn one after the other, so memory is that of the largest. The original's textures must be decoded before
/// (io::decode_base_colors()). Errors: bad_argument (those of validate()), empty, out_of_memory, cancelled.
Result<std::vector<LevelPictures>> draw_levels(const Ladder& ladder, const PictureOptions& options = {},
                                               Task task = {});

}  // namespace lodestone::report
