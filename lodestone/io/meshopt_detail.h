// EXT_meshopt_compression: the codec functions of libmeshoptimizer.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "lodestone/base/result.h"

namespace lodestone::io {

enum class MeshoptMode { attributes, triangles, indices };
enum class MeshoptFilter { none, octahedral, quaternion, exponential };

/// count * stride bytes. Refuses sizes that no such stream can hold before it reserves memory.
/// Errors: bad_format, unsupported (not built in).
Result<std::string> decode_meshopt(std::span<const std::byte> compressed, std::size_t count, std::size_t stride,
                                   MeshoptMode mode, MeshoptFilter filter, const std::string& where);

/// True if this build can encode.
bool has_meshopt();

/// Lossless. `stride` is a multiple of 4, at most 256; `vertices` holds whole elements.
std::string encode_meshopt_vertices(std::span<const std::byte> vertices, std::size_t stride);
/// Triangles keep their order and winding, but may start with another corner.
std::string encode_meshopt_triangles(std::span<const std::uint32_t> indices, std::size_t vertex_count);

}  // namespace lodestone::io
