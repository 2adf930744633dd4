// A glTF document for a model that came from another format.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "lodestone/io/gltf/pack_detail.h"

namespace lodestone::io {

/// The primitives of a mesh, one a group, without geometry. Groups of a model without materials may name some: those at
/// `materials` and above are left out.
Json fresh_primitives(const Mesh& mesh, std::size_t materials);

/// Scene, a node an instance (its index is the instance's), and meshes whose primitives still lack geometry (one a face
/// group, so that primitive g is group g).
Json make_fresh_document(const Model& model);

/// The transform of an instance and its mesh's offset.
Mat4d fresh_placing(const Model& model, std::size_t instance);
/// Gives a node this transform in place of the one that it has.
void place_fresh_node(Json& node, const Mat4d& placing);

/// Materials with their textures in the pack; what glTF does not hold of an MTL is told in `warnings`.
void add_fresh_materials(const Model& model, Json& json, GltfPack& pack, std::vector<std::string>& warnings);

/// A primitive without TEXCOORD_0 must not have a material with a texture: it gets that material's twin without.
void use_untextured_material(Json& json, Json& primitive);

}  // namespace lodestone::io
