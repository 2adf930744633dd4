// What the gltf*.cpp files share: the document's content, JSON access that never throws, accessors.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/model.h"
#include "lodestone/io/gltf/document.h"
#include "lodestone/io/read.h"

namespace lodestone::io {

using Json = nlohmann::ordered_json;
using ByteSpan = std::span<const std::byte>;

inline constexpr const char* kDraco = "KHR_draco_mesh_compression";
inline constexpr const char* kMeshopt = "EXT_meshopt_compression";  // as we write it
/// The same extension under both its names; the newer knows more codings.
inline constexpr const char* kMeshoptNames[] = {"KHR_meshopt_compression", kMeshopt};
inline constexpr const char* kInstancing = "EXT_mesh_gpu_instancing";
inline constexpr const char* kMsftLod = "MSFT_lod";
inline constexpr const char* kCoverage = "MSFT_screencoverage";

// ---- JSON (json.cpp) ----

/// Parses without recursion; nesting above 200 and text that is not JSON are bad_format with the byte.
Result<Json> parse_json(std::string_view text, const std::string& where);

/// The member, or null if `object` is no object or lacks it.
const Json* member(const Json& object, std::string_view key);
/// The array member, or an empty one.
const Json& array_member(const Json& object, std::string_view key);
/// The string member, or "".
std::string string_member(const Json& object, std::string_view key);
/// True if the array member `key` of `root` holds the string `value`.
bool lists(const Json& root, std::string_view key, std::string_view value);
/// An unsigned whole number (1.0 counts as one), at most 2^53.
std::optional<std::uint64_t> as_uint(const Json& value);
/// The number member, `fallback` if absent. Errors: bad_format if it isn't one.
Result<std::uint64_t> uint_member(const Json& object, std::string_view key, std::uint64_t fallback,
                                  const std::string& where);
/// An index below `limit`. Errors: bad_format if absent, not an index, or too large; `of` says what it counts.
Result<std::size_t> index_member(const Json& object, std::string_view key, std::size_t limit, const char* of,
                                 const std::string& where);
/// Up to N numbers of an array member; false if it is absent. Errors: bad_format for anything but `count` numbers.
Result<bool> numbers_member(const Json& object, std::string_view key, std::span<double> into, const std::string& where);

// ---- the document (document.cpp) ----

/// A buffer view, decoded when it was compressed.
struct View {
  ByteSpan bytes;
  std::size_t stride = 0;  ///< 0: tight
};

struct ExternalImage {
  std::size_t image = 0;  ///< index in the JSON
  std::string mime;
  ByteSpan bytes;
};

struct Document::Data {
  std::string name;                                         ///< of the file, for errors
  std::filesystem::path path;                               ///< empty when read from memory
  std::vector<std::filesystem::path> files;                 ///< buffers and images in files of their own
  Json json;                                                ///< as in the file, but data URIs of buffers removed
  std::vector<std::shared_ptr<const std::string>> storage;  ///< owns all bytes
  std::vector<ByteSpan> buffers;                            ///< one a JSON buffer; null where nothing needs its bytes
  std::vector<View> views;                                  ///< one a JSON bufferView
  std::vector<ExternalImage> images;                        ///< files found beside the .gltf
  std::vector<std::size_t> instance_nodes;                  ///< node of each instance of the Model
  std::vector<std::uint64_t> fingerprints;                  ///< of each Mesh as read: tells whether it was changed
  std::uint64_t file_bytes = 0;                             ///< all bytes read
};

/// Limits the memory that a file may unfold to, in bytes: shared, sparse or compressed parts can be named any number of
/// times, and that must cost no more than a small multiple of the file.
struct Budget {
  std::uint64_t left = 0;
  bool take(std::uint64_t amount) {
    if (amount > left) return false;
    left -= amount;
    return true;
  }
};
inline constexpr std::uint64_t kUnfoldFactor = 64, kUnfoldFloor = std::uint64_t{64} << 20;
inline Budget unfold_budget(std::uint64_t file_bytes) { return {file_bytes * kUnfoldFactor + kUnfoldFloor}; }
/// The error of a budget that is used up; `what` unfolds.
tl::unexpected<Error> unfolds_too_far(const Document::Data& data, std::string_view what, const std::string& where);

/// Container, JSON, buffers, images, views. `path` empty: no other files may be named. `options.levels` false:
/// drop_levels(), or keep_level() of `options.draw_level`.
Result<std::unique_ptr<Document::Data>> load_document(std::string bytes, std::string name,
                                                      const std::filesystem::path& path, const ReadOptions& options,
                                                      std::vector<std::string>& warnings, const Task& task);

/// The meshopt extension of a buffer or a buffer view, under either name; null if it has none.
const Json* meshopt_of(const Json& holder);
/// Buffers that only stand in for what meshopt compressed (tagged as that or not): their bytes may be missing.
std::vector<bool> unread_buffers(const Json& json);
/// Fills data.views from data.buffers (views.cpp).
Result<void> load_views(Document::Data& data, const Task& task);

/// Takes out MSFT_lod with the nodes that it names, their meshes and what only these use, as far as they are the last
/// of their kinds (as our writer leaves them): the indices of all others stay.
void drop_levels(Json& json);

/// As drop_levels(), but what has levels becomes its level `level` (from 1; its coarsest where it has fewer). Geometry
/// that nobody names any more loses its bytes, not its indices: returns the views that are to be emptied.
std::vector<std::size_t> keep_level(Json& json, std::size_t level);

/// "file.glb: accessor 3"
std::string place(const Document::Data& data, std::string_view what, std::size_t index);

/// The bytes of JSON image `image` (buffer view, data URI or external file) and its MIME type; empty when missing.
struct ImageBytes {
  std::string bytes, mime;
};
ImageBytes image_bytes(const Document::Data& data, std::size_t image);

// ---- GLB (glb.cpp) ----

struct GlbParts {
  std::string_view json, bin;
};
bool is_glb(std::string_view bytes);
/// Errors: bad_format (lengths that lie, chunks missing), unsupported (version 1).
Result<GlbParts> split_glb(std::string_view bytes, const std::string& where, std::vector<std::string>& warnings);

// ---- accessors (accessor.cpp) ----

/// Elements somewhere in memory: checked, so that `count` elements are there. Sparse ones are made dense.
struct Accessor {
  std::size_t index = 0;
  std::size_t count = 0;
  std::size_t components = 1;
  ComponentType type = ComponentType::float32;
  bool normalized = false;
  const std::byte* data = nullptr;
  std::size_t stride = 0;
  std::shared_ptr<const std::vector<std::byte>> own;  ///< keeps `data` alive where it isn't the document's
  std::string where;                                  ///< "file.glb: accessor 3"
};

std::optional<ComponentType> component_type(std::uint64_t gltf_number);
unsigned gltf_number(ComponentType type);
/// Components of "SCALAR", "VEC3", "MAT4" …; 0 for others.
std::size_t components_of(std::string_view type);

/// `budget` (may be null) pays for elements that must be copied: sparse ones, and zeros of no buffer view.
/// Errors: bad_format.
Result<Accessor> find_accessor(const Document::Data& data, std::size_t index, Budget* budget = nullptr);

/// Values of the elements `ids` (empty: all in order) as floats, normalised integers divided. Writes
/// out[i * out_components + c]; components that the accessor lacks become `missing`.
void gather(const Accessor& accessor, std::span<const std::uint32_t> ids, std::size_t count, float* out,
            std::size_t out_components, float missing, const Task& task);
/// The same as 32-bit patterns: integers as they are, floats bit for bit.
void gather_bits(const Accessor& accessor, std::span<const std::uint32_t> ids, std::size_t count, std::uint32_t* out,
                 std::size_t out_components, const Task& task);

// ---- meshes and scene (mesh.cpp, scene.cpp, material.cpp) ----

/// What an attribute's name means.
struct AttributeKind {
  Semantic semantic = Semantic::generic;
  std::uint32_t set = 0;
};
AttributeKind attribute_kind(std::string_view name, bool morph);

/// True for triangles, strips and fans.
bool is_triangle_primitive(const Json& primitive);
bool is_draco_primitive(const Json& primitive);

struct DracoCache;  // decoded buffer views, so that shared ones are decoded once

/// Mesh `index` of the document, not yet welded. Adds to the model's file counts and warnings.
Result<Mesh> read_mesh(const Document::Data& data, std::size_t index, Budget& budget, DracoCache& cache, Model& model,
                       const Task& task);

/// Fills instances and data.instance_nodes. `draw_level`: as in ReadOptions.
Result<void> read_scene(Document::Data& data, Model& model, Budget& budget, std::size_t draw_level);

std::vector<Material> read_materials(const Document::Data& data);

/// 64-bit hash over everything that writing depends on: geometry, groups, streams.
std::uint64_t fingerprint(const Mesh& mesh);

}  // namespace lodestone::io
