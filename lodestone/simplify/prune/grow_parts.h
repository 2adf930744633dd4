// Growing parts: those that are left of a mesh of many small pieces take over the area of those that have vanished.
#pragma once

#include <cstdint>
#include <vector>

#include "lodestone/core/mesh.h"
#include "lodestone/math/mat.h"
#include "lodestone/simplify/prune/prune_order.h"

namespace lodestone::simplify {

struct GrowTargets {
  const std::vector<double>& area_of_part;  ///< that each part stands for, units of the metric squared
  double most = 0;                          ///< no vertex moves farther, units of the metric
  Mat4d metric;                             ///< mesh space to where areas and moves are judged
};

/// Enlarges the parts of `mesh`, a level of `original`, about their centroids until each has the area that it stands
/// for, or a little more where a part is round. A leaf grows in its plane, a strut across: vertices move as little as
/// they can, and none farther than `most`. A part that would have to move more than twice as far is left as it is, and
/// so are those of PruneOrder::no_prune. Normals, tangents and morph targets go along. `origin`: for each triangle the
/// original's that it comes from. O(mesh).
void grow_parts(const Mesh& original, const PruneOrder& order, const GrowTargets& targets,
                const std::vector<std::uint32_t>& origin, Mesh& mesh);

}  // namespace lodestone::simplify
