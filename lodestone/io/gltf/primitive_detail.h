// One triangle primitive of a glTF mesh, its parts found and checked but not yet copied.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "lodestone/io/draco_detail.h"
#include "lodestone/io/gltf/gltf_detail.h"

namespace lodestone::io {

/// Decoded Draco buffer views of the document, so that one that primitives share is decoded once.
struct DracoCache {
  std::map<std::size_t, std::shared_ptr<const DracoMesh>> meshes;
};

using NamedAccessors = std::vector<std::pair<std::string, Accessor>>;

struct PrimitiveSource {
  Accessor positions;
  NamedAccessors attributes;            ///< without POSITION, in the order of the file
  std::vector<NamedAccessors> targets;  ///< morph targets
  std::vector<Triangle> triangles;      ///< into `vertices`
  std::vector<std::uint32_t> vertices;  ///< used elements of the accessors, ascending; empty = all in order
  std::size_t vertex_count = 0;         ///< used
  std::uint32_t material = kNone;
};

/// Finds and checks everything; strips and fans become triangles (a strip's stitching triangles are left out).
/// Errors: bad_format naming primitive or accessor; unsupported (Draco not built in).
Result<PrimitiveSource> read_primitive(const Document::Data& data, const Json& primitive, const std::string& where,
                                       Budget& budget, DracoCache& cache, std::vector<std::string>& warnings);

}  // namespace lodestone::io
