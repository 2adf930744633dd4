// MSFT_lod: coarser nodes beside the nodes of the scene.
#pragma once

#include <vector>

#include "lodestone/io/gltf/gltf_detail.h"

namespace lodestone::io {

/// A transform that the format forbids: a rotation that is no unit quaternion or has a component above one, a matrix
/// that shears, projects or flattens, or a matrix beside other parts of a transform.
bool has_odd_transform(const Json& node);

struct NodeLevels {
  std::size_t holder = 0;           ///< the node that carries the levels: the one asked for, or its new leaf
  std::vector<std::size_t> levels;  ///< the node of each coarser level, placed as the holder is
};

/// Gives node `node`, which carries a mesh, its coarser levels. level_meshes[k] is the JSON mesh of level k + 1, kNone
/// where nothing is left of it. A node that has children, is animated, is a joint, carries a camera or a light, or has
/// an odd transform (or a matrix that is too large to pass for a good one) hands its mesh and skin to a new identity
/// leaf; weight animations follow the mesh and are repeated for each level. `coverage`: MSFT_screencoverage, one value
/// a level with level 0; empty = none.
NodeLevels add_node_levels(Json& json, std::size_t node, const std::vector<std::size_t>& level_meshes,
                           const std::vector<double>& coverage, std::vector<std::string>& warnings);

/// Weight animations of a node that lost its mesh come to nothing: their channels name no node any more.
void detach_weight_channels(Json& json, std::size_t node);

}  // namespace lodestone::io
