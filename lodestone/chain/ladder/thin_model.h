// Whether a model is made of thin parts: leaves, struts, wires, whose number no collapse lowers.
#pragma once

#include <cstddef>

#include "lodestone/base/task.h"
#include "lodestone/core/model.h"

namespace lodestone::chain {

struct ThinShare {
  std::size_t parts = 0;  ///< drawn pieces that share no vertex with another; each instance has its own
  double area = 0;        ///< share of the drawn area, 0 to 1, in parts that are thin beside the model; of one part 0
};

/// A part is thin when it is at most a twentieth of the model's diagonal across in two directions, be it long in the
/// third (a strut, a wire) or not (a leaf): four times the standard deviation of its vertices along the middle one of
/// its principal axes. World space. O(what is drawn).
ThinShare thin_share(const Model& model, const Task& task = {});

/// Whether a level of so many triangles needs parts that vanish while others grow (SimplifyConstraints::keep_area):
/// most of the area is in thin parts, of which there are many, and fewer than 16 triangles a part would be left.
bool needs_keep_area(const ThinShare& share, std::size_t smallest_triangles);

}  // namespace lodestone::chain
