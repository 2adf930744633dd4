// Mending what a glTF file has against its own specification, so that what is written is valid.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "lodestone/io/gltf/pack_detail.h"

namespace lodestone::io {

/// A vertex's influences over all its sets, made possible: no weight is negative or infinite, no joint that pulls is
/// named twice or is not below `joint_count`. True if anything was wrong.
bool settle_influences(std::span<std::uint32_t> joints, std::span<double> weights, std::uint32_t joint_count);

/// The joints of the smallest skin that mesh `mesh` is drawn with; kNone without any.
std::uint32_t joint_count_of(const Json& json, std::size_t mesh);

/// Influences of each wedge settled, weights scaled to sum one over all sets (a wedge without any weight gets its first
/// joint). True if any was off by more than a thousandth.
bool repair_skin(Mesh& mesh, std::uint32_t joint_count);

/// Attribute values that are not finite become zero; returns their number.
std::uint64_t zero_non_finite(Mesh& mesh);

/// Arrays of morph weights get the length that the targets ask for.
void repair_weights(Json& json);

/// Lists KHR_mesh_quantization where attributes are stored as only it allows and nobody said so.
void list_quantization(Json& json);

/// Bytes of views, by index, in place of the document's.
using MendedViews = std::map<std::size_t, std::string>;
/// Skin weights, normals, tangents and colours that stay as the document has them, and are not valid. Told in
/// `warnings`.
MendedViews mend_values(const Document::Data& data, const std::vector<bool>& rewritten,
                        std::vector<std::string>& warnings);

/// Declared minima and maxima that are not those of the values (as `mended`), or that lack where there must be some
/// (positions, times of animations); byteStride on views of accessors that must be tight (skins, animations) where it
/// says nothing.
void repair_accessors(const Document::Data& data, const MendedViews& mended, Json& json);

/// Views that only accessors of the rewritten meshes' triangle primitives use, Draco's included: free for other use.
/// These accessors lose their view in `json`.
std::vector<bool> release_views(const Document::Data& data, const std::vector<bool>& rewritten, Json& json);

}  // namespace lodestone::io
