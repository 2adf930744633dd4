// GltfPack: new accessors and buffer views of a glTF file being written, kept apart by level until the binary chunk is
// laid out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "lodestone/io/gltf/gltf_detail.h"
#include "lodestone/io/write.h"

namespace lodestone::io {

class GltfPack {
 public:
  GltfPack(Json& json, Compression compression, std::size_t levels)
      : json_(json), compression_(compression), bytes_(levels) {}

  Compression compression() const { return compression_; }

  /// A tight array of `count` elements of `stride` bytes (a multiple of 4) of vertex data; returns the view's index.
  std::size_t add_vertices(std::size_t level, std::string bytes, std::size_t stride);
  /// Triangle corners below `vertices`, as 16 or 32 bits; returns the view's index.
  std::size_t add_indices(std::size_t level, const std::vector<std::uint32_t>& corners, std::size_t vertices);
  /// Any bytes, never compressed (images, Draco streams, views of the original).
  std::size_t add_bytes(std::size_t level, std::string_view bytes);
  /// The bytes of an existing view, which keeps its index and properties, but extensions that say where its bytes lie
  /// (compression): these would name a place in a buffer that is no more.
  void set_view(std::size_t view, std::size_t level, std::string_view bytes);
  /// An existing view that nothing needs any more: its index is used for the next new one.
  void free_view(std::size_t view) { free_.push_back(view); }

  /// Names of the extensions that set_view() took out.
  const std::set<std::string>& moved_extensions() const { return moved_; }

  std::size_t add_accessor(Json accessor);
  /// The accessor whose index `index` holds; null if it is null or no index.
  const Json* find_accessor_json(const Json* index) const;

  /// Lays out the binary chunk, the coarsest level first, and fills `buffers` and the views' places. Call once, at the
  /// end.
  std::string finish();
  /// Bytes of each level's own views in the binary chunk, after finish().
  const std::vector<std::uint64_t>& level_bytes() const { return sizes_; }

 private:
  struct Location {
    std::size_t view, level, offset;
    bool meshopt;
  };
  std::size_t new_view(Json view);
  std::size_t append(std::size_t level, std::string_view bytes);

  Json& json_;
  Compression compression_;
  std::vector<std::string> bytes_;    // a level, until finish()
  std::vector<std::uint64_t> sizes_;  // a level, from then on
  std::vector<Location> places_;
  std::vector<std::size_t> free_;
  std::set<std::string> moved_;
  std::uint64_t fallback_bytes_ = 0;
};

/// Adds a name to an array of the root such as extensionsUsed, once.
void list_extension(Json& root, const char* key, std::string_view name);
/// Takes it out again; an empty array goes as well.
void unlist_extension(Json& root, const char* key, std::string_view name);

}  // namespace lodestone::io
