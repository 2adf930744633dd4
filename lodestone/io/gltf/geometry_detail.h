// A face group of a Mesh as a glTF primitive: which streams it has, and their bytes.
#pragma once

#include <string>
#include <vector>

#include "lodestone/io/gltf/columns_detail.h"
#include "lodestone/io/gltf/pack_detail.h"

namespace lodestone::io {

/// For a mesh read from glTF (`named`: the document's mesh; stream names are attribute names, those that glTF does not
/// allow become legal_names()) or from another format (null; names made from meanings). What glTF cannot hold is left
/// out and told in `warnings`, once a name.
std::vector<AttributePlan> plan_attributes(const Mesh& mesh, const Json* named, bool flip_v,
                                           std::vector<std::string>& warnings);

/// Writes a group of `mesh` into the pack and returns the primitive: `source` with new attributes, indices and targets;
/// everything else in it stays, but extensions that name the old geometry. Null if the group has no triangles. Tells in
/// `warnings` what could not be compressed as asked, once.
Json pack_primitive(GltfPack& pack, std::size_t level, const Mesh& mesh, const GroupIndex& index,
                    const std::vector<AttributePlan>& plans, const Json& source, std::vector<std::string>& warnings);

/// Takes extensions out of a mesh or primitive whose content is the old geometry (outlines, manifold merges), and
/// tells.
void drop_geometry_extensions(Json& object, std::vector<std::string>& warnings);

}  // namespace lodestone::io
