// Mending what a glTF file has against its own specification, so that what is written is valid.
#pragma once

#include <vector>

#include "lodestone/io/gltf_pack_detail.h"

namespace lodestone::io {

/// Skin weights of each wedge scaled to sum one over all sets (a wedge without any weight gets its first joint). True
/// if any was off by more than a thousandth.
bool normalize_weights(Mesh& mesh);

/// Attribute values that are not finite become zero; returns their number.
std::uint64_t zero_non_finite(Mesh& mesh);

/// Declared minima and maxima of float accessors that are not those of their values; byteStride on views of accessors
/// that must be tight (skins, animations) where it says nothing.
void repair_accessors(const Document::Data& data, Json& json);

/// Views that only accessors of the rewritten meshes' triangle primitives use, Draco's included: free for other use.
/// These accessors lose their view in `json`.
std::vector<bool> release_views(const Document::Data& data, const std::vector<bool>& rewritten, Json& json);

}  // namespace lodestone::io
