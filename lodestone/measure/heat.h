// Heat maps: a surface whose vertices say how far they are from another one.
#pragma once

#include <cstddef>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/input.h"
#include "lodestone/core/model.h"

namespace lodestone::measure {

struct HeatOptions {
  /// Triangles are split where the distance at the middle of a side or of the triangle is not what their corners say,
  /// by more than this share of the largest distance: else large triangles would hide what lies between their corners.
  double tolerance = 0.02;
  double shortest_side = 0.002;            ///< of A's diagonal: sides shorter than this are not split
  double longest_side = 0.03;              ///< of A's diagonal: longer ones are split whatever their middles say
  std::size_t most_triangles = 2'000'000;  ///< splitting ends before there are more, unless A has more itself
  bool linear_colors = true;               ///< COLOR_0 as light, as glTF has it; false: as sRGB, as PLY has it
  Input input = Input::unchecked;          ///< of both models
};

struct Heat {
  /// A's default scene in world space as one mesh, with two streams a vertex: `_ERROR` (float32, distance to B in model
  /// units) and `COLOR_0` (8-bit RGB by render::heat_color, from 0 to the range). A's own attributes are left out.
  Model model;
  double largest = 0;        ///< of `_ERROR`; the true maximum may lie between vertices: measure::hausdorff bounds it
  double percentile_99 = 0;  ///< 99 % of A's area is nearer than this, as far as vertices tell
  /// What got the last colour: percentile_99, at least a twentieth of the largest; 0 where all distances are rounding.
  double range = 0;
  std::size_t triangles = 0;  ///< of A as drawn, before splitting
};

/// How far A's surface is from B's, place by place (one direction: swap the models for the other). Same bytes for any
/// thread count. O(n log n). Errors: bad_argument (those of validate()), empty, cancelled.
Result<Heat> heat_map(const Model& a, const Model& b, const HeatOptions& options = {}, Task task = {});

}  // namespace lodestone::measure
