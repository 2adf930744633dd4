// The vertex element of a PLY file: positions and streams from its properties.
#pragma once

#include <vector>

#include "lodestone/base/result.h"
#include "lodestone/core/model.h"
#include "lodestone/io/plain/ply_header_detail.h"
#include "lodestone/io/plain/ply_values_detail.h"
#include "lodestone/io/read_detail.h"

namespace lodestone::io {

/// Which properties make one stream.
struct PlyStream {
  std::string name;  ///< the properties' names with blanks between
  Semantic semantic = Semantic::generic;
  std::uint32_t set = 0;
  ComponentType type = ComponentType::float32;
  bool normalized = false;
  std::vector<std::size_t> properties;  ///< of the element, one a component
};

/// The streams of an element's scalar properties but x, y and z.
std::vector<PlyStream> ply_streams(const PlyElement& vertices);

/// Reads all records of the element into model.meshes[0]: positions, offset, and one value a vertex in each stream.
/// Errors: bad_format, unsupported, cancelled.
Result<void> read_ply_vertices(PlyValues& values, const PlyElement& element, Model& model, ReadProgress& progress);

}  // namespace lodestone::io
