// Normals for what comes without.
#pragma once

#include <vector>

#include "lodestone/base/task.h"
#include "lodestone/render/packed_normal_detail.h"
#include "lodestone/render/scene_detail.h"
#include "lodestone/spatial/surface.h"

namespace lodestone::render::detail {

/// A normal for each corner: the weighted sum over the faces around the vertex that meet the corner's face at less than
/// 50 degrees, so that round things are drawn round and edges sharp. Weights: Max, "Weights for computing vertex
/// normals from facet normals", 1999. Corners of faces without area, and at vertices of more than 64 faces (tips of
/// cones), get their face's. O(n).
std::vector<Corners<PackedNormal>> smooth_normals(const spatial::Surface& surface, const Task& task);

}  // namespace lodestone::render::detail
