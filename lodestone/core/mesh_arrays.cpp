#include "lodestone/core/mesh_arrays.h"

#include <fmt/format.h>

#include <cstring>
#include <utility>
#include <variant>

#include "lodestone/core/validate.h"
#include "lodestone/core/weld.h"

namespace lodestone {

namespace {

tl::unexpected<Error> unfit(std::string what, std::string remedy) {
  return fail(ErrorCode::bad_argument, std::move(what), "mesh arrays", std::move(remedy));
}

bool is_of_floats(Semantic semantic) {
  return semantic != Semantic::joints && semantic != Semantic::weights && semantic != Semantic::categorical;
}

Result<void> check_array(const FloatArray& array, std::size_t components, const std::string& what) {
  if (array.data == nullptr) return unfit(what + " has no values", "point its data at them");
  const std::size_t least = components * sizeof(float);
  if (array.stride_bytes == 0 || (array.stride_bytes >= least && array.stride_bytes % sizeof(float) == 0)) return {};
  return unfit(
      fmt::format("{} has {} bytes from vertex to vertex, but {} values", what, array.stride_bytes, components),
      fmt::format("give a multiple of 4 of at least {}, or 0", least));
}

Result<void> check_counts(const MeshArrays& arrays) {
  if (arrays.vertices >= kNone) {
    return unfit(fmt::format("{} vertices are more than 32-bit indices reach", arrays.vertices), "split the mesh");
  }
  if (arrays.indices.size() % 3 != 0) {
    return unfit(fmt::format("{} indices are no triples", arrays.indices.size()), "give three a triangle");
  }
  for (std::size_t i = 0; i < arrays.indices.size(); ++i) {
    if (arrays.indices[i] < arrays.vertices) continue;
    return unfit(fmt::format("triangle {} names vertex {} of {}", i / 3, arrays.indices[i], arrays.vertices),
                 "count vertices from 0");
  }
  return {};
}

Result<void> check(const MeshArrays& arrays) {
  LODESTONE_TRY(check_counts(arrays));
  if (arrays.vertices == 0) return {};
  LODESTONE_TRY(check_array(arrays.positions, 3, "the array of positions"));
  for (const AttributeArray& attribute : arrays.attributes) {
    const std::string what = fmt::format("attribute '{}'", attribute.name);
    if (!is_of_floats(attribute.semantic)) {
      return unfit(what + " is of a kind whose values are whole numbers or belong together", "fill Mesh::attributes");
    }
    if (attribute.components == 0 || attribute.components > 16) {
      return unfit(fmt::format("{} has {} components", what, attribute.components), "give 1 to 16");
    }
    LODESTONE_TRY(check_array(attribute.values, attribute.components, what));
  }
  return {};
}

// The components of one vertex after the other.
void copy_tuples(const FloatArray& from, std::size_t vertices, std::size_t components, float* to) {
  const auto* bytes = reinterpret_cast<const std::byte*>(from.data);
  const std::size_t size = components * sizeof(float), stride = from.stride_bytes == 0 ? size : from.stride_bytes;
  for (std::size_t v = 0; v < vertices; ++v) std::memcpy(to + v * components, bytes + v * stride, size);
}

}  // namespace

Result<Mesh> from_arrays(const MeshArrays& arrays, const FromArraysOptions& options, Task task) {
  LODESTONE_TRY(check(arrays));
  Mesh mesh;
  std::vector<float> values(3 * arrays.vertices);
  if (arrays.vertices > 0) copy_tuples(arrays.positions, arrays.vertices, 3, values.data());
  mesh.positions.reserve(arrays.vertices);
  for (std::size_t i = 0; i < values.size(); i += 3)
    mesh.positions.push_back({values[i], values[i + 1], values[i + 2]});
  mesh.triangles.reserve(arrays.indices.size() / 3);
  for (std::size_t i = 0; i < arrays.indices.size(); i += 3) {
    mesh.triangles.push_back({arrays.indices[i], arrays.indices[i + 1], arrays.indices[i + 2]});
  }
  for (const AttributeArray& attribute : arrays.attributes) {
    AttributeStream stream = make_stream(attribute.name, attribute.semantic, attribute.components,
                                         ComponentType::float32, false, arrays.vertices);
    stream.set = attribute.set;
    if (arrays.vertices > 0) {
      copy_tuples(attribute.values, arrays.vertices, attribute.components,
                  std::get<std::vector<float>>(stream.values).data());
    }
    mesh.attributes.push_back(std::move(stream));
  }
  LODESTONE_TRY(validate(mesh, task));
  if (!options.weld) return mesh;
  return weld_exact(std::move(mesh), std::move(task));
}

MeshBuffers to_arrays(const Mesh& mesh) {
  MeshBuffers out;
  out.offset = mesh.offset;
  const std::size_t wedges = mesh.wedge_count();
  out.positions.reserve(3 * wedges);
  for (std::uint32_t w = 0; w < wedges; ++w) {
    const Vec3f& p = mesh.positions[mesh.vertex_of(w)];
    out.positions.insert(out.positions.end(), {p.x, p.y, p.z});
  }
  out.indices.reserve(3 * mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) out.indices.insert(out.indices.end(), t.begin(), t.end());
  for (const AttributeStream& stream : mesh.attributes) {
    const auto* values = std::get_if<std::vector<float>>(&stream.values);
    if (values == nullptr || !is_of_floats(stream.semantic)) continue;
    out.attributes.push_back({stream.name, stream.semantic, stream.set, stream.components, *values});
  }
  return out;
}

}  // namespace lodestone
