// Colours of a scan's points on its surface.
#pragma once

#include <string>
#include <vector>

#include "lodestone/base/task.h"
#include "lodestone/core/mesh.h"
#include "lodestone/core/point_cloud.h"
#include "lodestone/spatial/kd_tree.h"

namespace lodestone::chain {

/// Gives each vertex the colour of the eight points nearest to it, averaged as light, near ones counting more, in a
/// stream COLOR_0 of 16 bits: the points' colours are sRGB, those of a mesh are light, as glTF wants it. `tree` is over
/// the cloud's positions, `spacing` that of its points, model units. Nothing where the cloud has no colours; where all
/// are black, as in files whose format has a place for colours that nobody filled, that is told in `warnings`.
void add_scan_colors(const PointCloud& cloud, const spatial::KdTree& tree, double spacing, Mesh& mesh,
                     std::vector<std::string>& warnings, const Task& task);

}  // namespace lodestone::chain
