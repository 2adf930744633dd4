// EXT_meshopt_compression and KHR_meshopt_compression: the codec functions of libmeshoptimizer, and what its version in
// Debian 12 doesn't know yet.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "lodestone/base/result.h"

namespace lodestone::io {

enum class MeshoptMode { attributes, triangles, indices };
enum class MeshoptFilter { none, octahedral, quaternion, exponential, color };

/// What the extension says of a view: `count` elements of `stride` bytes.
struct MeshoptCoding {
  MeshoptMode mode = MeshoptMode::attributes;
  MeshoptFilter filter = MeshoptFilter::none;
  std::size_t count = 0, stride = 0;
};

/// Refuses what the format forbids and sizes that no stream of `compressed` bytes can hold. Errors: bad_format.
Result<void> check_meshopt(const MeshoptCoding& coding, std::size_t compressed, const std::string& where);

/// count * stride bytes. `coding` must have passed check_meshopt(). Errors: bad_format, unsupported (not built in).
Result<std::string> decode_meshopt(std::span<const std::byte> compressed, const MeshoptCoding& coding,
                                   const std::string& where);

/// Version 1 of the attribute codec, which KHR_meshopt_compression brought, into `out` (count * stride bytes). False
/// if the stream is broken. O(out).
bool decode_meshopt_version_1(std::span<const std::byte> compressed, std::size_t count, std::size_t stride, char* out);

/// The filter COLOR: YCoCg to RGBA, in place; `stride` is 4 (bytes) or 8 (16 bits each).
void decode_meshopt_colors(char* elements, std::size_t count, std::size_t stride);

/// True if this build can encode and decode.
bool has_meshopt();

/// Lossless. `stride` is a multiple of 4, at most 256; `vertices` holds whole elements.
std::string encode_meshopt_vertices(std::span<const std::byte> vertices, std::size_t stride);
/// Triangles keep their order and winding, but may start with another corner.
std::string encode_meshopt_triangles(std::span<const std::uint32_t> indices, std::size_t vertex_count);

}  // namespace lodestone::io
