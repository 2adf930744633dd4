// Draco streams in and out: the library's types stay in draco.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lodestone/base/result.h"
#include "lodestone/core/attributes.h"

namespace lodestone::io {

enum class DracoKind { position, normal, color, texcoord, generic };

/// One attribute, a tight tuple a point.
struct DracoAttribute {
  std::uint32_t id = 0;  ///< unique id in the stream
  DracoKind kind = DracoKind::generic;
  ComponentType type = ComponentType::float32;
  bool normalized = false;
  std::size_t components = 3;
  std::shared_ptr<const std::vector<std::byte>> values;
};

struct DracoMesh {
  std::size_t points = 0;
  std::vector<std::uint32_t> indices;  ///< three a triangle, all below `points`
  std::vector<DracoAttribute> attributes;
};

/// True if this build can decode and encode.
bool has_draco();

/// Errors: bad_format (with the library's reason), unsupported (not built in), empty (a point cloud).
Result<DracoMesh> decode_draco(std::string_view bytes, const std::string& where);

struct DracoEncoded {
  std::string bytes;
  std::size_t points = 0, triangles = 0;  ///< as a decoder will find them
};

/// Lossless: no attribute is quantised. `keep_order` keeps the numbering of points and triangles.
/// Errors: unsupported (not built in), bad_argument (with the library's reason).
Result<DracoEncoded> encode_draco(const DracoMesh& mesh, bool keep_order);

}  // namespace lodestone::io
