// A face group of a Mesh as a glTF primitive: which streams it has, and their bytes.
#pragma once

#include <string>
#include <vector>

#include "lodestone/io/gltf_pack_detail.h"

namespace lodestone::io {

/// How streams are named and stored, decided once for a mesh.
struct AttributePlan {
  std::size_t stream = 0;      ///< index in Mesh::attributes
  std::string name;            ///< "TEXCOORD_0", "_QUALITY"
  std::size_t target = kNone;  ///< morph target, kNone for a plain attribute
  ComponentType type = ComponentType::float32;
  bool normalized = false;
  bool flip_v = false;  ///< v' = 1 - v
};

/// For a mesh read from glTF (`named`: stream names are attribute names) or from another format (names made from
/// meanings). What glTF cannot hold is left out and told in `warnings`, once a name.
std::vector<AttributePlan> plan_attributes(const Mesh& mesh, bool named, bool flip_v,
                                           std::vector<std::string>& warnings);

/// Writes group `group` of `mesh` into the pack and returns the primitive: `source` with new attributes, indices and
/// targets; everything else in it stays. Null if the group has no triangles. `targets`: morph targets that the mesh
/// has.
Json pack_primitive(GltfPack& pack, std::size_t level, const Mesh& mesh, std::size_t group,
                    const std::vector<AttributePlan>& plans, const Json& source);

}  // namespace lodestone::io
