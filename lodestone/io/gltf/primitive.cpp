// A primitive's accessors (plain or Draco), its triangles, and which of its vertices they use.
#include "lodestone/io/gltf/primitive_detail.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>

namespace lodestone::io {

namespace {

enum Mode : std::uint64_t { kTriangles = 4, kStrip = 5, kFan = 6 };

std::uint64_t mode_of(const Json& primitive) {
  const Json* mode = member(primitive, "mode");
  return mode == nullptr ? std::uint64_t{kTriangles} : as_uint(*mode).value_or(99);
}

const Json* draco_extension(const Json& primitive) {
  const Json* extensions = member(primitive, "extensions");
  return extensions != nullptr ? member(*extensions, kDraco) : nullptr;
}

Result<Accessor> accessor_member(const Document::Data& data, const Json& object, std::string_view key,
                                 const std::string& where, Budget& budget) {
  const std::size_t count = array_member(data.json, "accessors").size();
  const Result<std::size_t> index = index_member(object, key, count, "accessors", where);
  LODESTONE_TRY(index);
  return find_accessor(data, *index, &budget);
}

// What Semantic demands of the number of components; 0 = up to 4.
std::pair<std::size_t, std::size_t> components_allowed(const std::string& name, bool morph) {
  const Semantic semantic = attribute_kind(name, morph).semantic;
  switch (semantic) {
    case Semantic::normal:
    case Semantic::morph_position:
    case Semantic::morph_normal:
    case Semantic::morph_tangent:
      return {3, 3};
    case Semantic::tangent:
    case Semantic::joints:
    case Semantic::weights:
      return {4, 4};
    case Semantic::uv:
      return {2, 2};
    case Semantic::color:
      return {3, 4};
    default:
      return {1, 4};
  }
}

Result<NamedAccessors> read_named(const Document::Data& data, const Json& attributes, bool morph,
                                  const std::string& where, const std::vector<std::string>& skip, Budget& budget,
                                  std::vector<std::string>& warnings) {
  NamedAccessors out;
  if (!attributes.is_object()) return fail(ErrorCode::bad_format, "attributes are not an object", where);
  for (const auto& [name, index] : attributes.items()) {
    if (std::find(skip.begin(), skip.end(), name) != skip.end()) continue;
    Result<Accessor> accessor = accessor_member(data, attributes, name, where, budget);
    LODESTONE_TRY(accessor);
    const bool positions = name == "POSITION" && !morph;
    const auto [least, most] = positions ? std::pair<std::size_t, std::size_t>{3, 3} : components_allowed(name, morph);
    const bool custom = name.starts_with('_');
    if (accessor->components < least || accessor->components > most) {
      if (custom) {
        warnings.push_back(fmt::format("{}: attribute {} has {} components; coarser levels go without it", where, name,
                                       accessor->components));
        continue;
      }
      return fail(ErrorCode::bad_format,
                  fmt::format("{} has {} components, it must have {}", name, accessor->components, least),
                  accessor->where);
    }
    out.emplace_back(name, std::move(*accessor));
  }
  return out;
}

Result<std::shared_ptr<const DracoMesh>> decode_view(const Document::Data& data, const Json& draco,
                                                     const std::string& where, Budget& budget, DracoCache& cache) {
  const Result<std::size_t> view = index_member(draco, "bufferView", data.views.size(), "buffer views", where);
  LODESTONE_TRY(view);
  std::shared_ptr<const DracoMesh>& slot = cache.meshes[*view];
  if (slot == nullptr) {
    const ByteSpan bytes = data.views[*view].bytes;
    Result<DracoMesh> mesh = decode_draco({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, where);
    LODESTONE_TRY(mesh);
    std::uint64_t unfolded = mesh->indices.size() * sizeof(std::uint32_t);
    for (const DracoAttribute& a : mesh->attributes) unfolded += a.values->size();
    if (!budget.take(unfolded)) return unfolds_too_far(data, "the Draco streams", where);
    slot = std::make_shared<const DracoMesh>(std::move(*mesh));
  }
  return slot;
}

Result<Accessor> draco_accessor(const Document::Data& data, const DracoMesh& mesh, std::uint64_t id,
                                const std::string& name, const Json& attributes, const std::string& where) {
  for (const DracoAttribute& attribute : mesh.attributes) {
    if (attribute.id != id) continue;
    Accessor out;
    out.where = fmt::format("{}: Draco attribute {}", where, id);
    out.count = mesh.points;
    out.components = attribute.components;
    out.type = attribute.type;
    out.normalized = attribute.normalized;
    out.own = attribute.values;
    out.data = attribute.values->data();
    out.stride = attribute.components * size_of(attribute.type);
    // The accessor that stands for it in the JSON says how integers are meant, and is what errors can name.
    const Json& accessors = array_member(data.json, "accessors");
    if (const Result<std::size_t> index = index_member(attributes, name, accessors.size(), "accessors", where); index) {
      const Json* normalized = member(accessors[*index], "normalized");
      out.index = *index;
      out.normalized = normalized != nullptr && normalized->is_boolean() && normalized->get<bool>() &&
                       out.type != ComponentType::float32;
    }
    return out;
  }
  return fail(ErrorCode::bad_format, fmt::format("{} is Draco attribute {}, which the stream lacks", name, id), where);
}

// Attributes that the Draco stream holds; the names taken are added to `done`.
Result<NamedAccessors> read_draco_attributes(const Document::Data& data, const Json& primitive, const DracoMesh& mesh,
                                             const std::string& where, std::vector<std::string>& done) {
  NamedAccessors out;
  const Json* ids = member(*draco_extension(primitive), "attributes");
  const Json* attributes = member(primitive, "attributes");
  if (ids == nullptr || !ids->is_object()) return out;
  for (const auto& [name, value] : ids->items()) {
    const std::optional<std::uint64_t> id = as_uint(value);
    if (!id) return fail(ErrorCode::bad_format, fmt::format("Draco attribute {} is not a number", name), where);
    Result<Accessor> accessor = draco_accessor(data, mesh, *id, name, *attributes, where);
    LODESTONE_TRY(accessor);
    const auto [least, most] =
        name == "POSITION" ? std::pair<std::size_t, std::size_t>{3, 3} : components_allowed(name, false);
    if (accessor->components < least || accessor->components > most) {
      return fail(ErrorCode::bad_format, fmt::format("{} has {} components", name, accessor->components),
                  accessor->where);
    }
    out.emplace_back(name, std::move(*accessor));
    done.push_back(name);
  }
  return out;
}

// The primitive's index list; without indices 0, 1, 2 ... All are below `vertices`.
Result<std::vector<std::uint32_t>> read_indices(const Document::Data& data, const Json& primitive, std::size_t vertices,
                                                const std::string& where, Budget& budget) {
  std::vector<std::uint32_t> out;
  constexpr std::size_t kBytesEach = sizeof(std::uint32_t) + sizeof(Triangle);  // a strip has a triangle a corner
  if (member(primitive, "indices") == nullptr) {
    if (!budget.take(vertices * kBytesEach)) return unfolds_too_far(data, "the primitives", where);
    out.resize(vertices);
    for (std::size_t i = 0; i < vertices; ++i) out[i] = static_cast<std::uint32_t>(i);
    return out;
  }
  const Result<Accessor> accessor = accessor_member(data, primitive, "indices", where, budget);
  LODESTONE_TRY(accessor);
  if (accessor->components != 1 || accessor->normalized || accessor->type == ComponentType::float32 ||
      accessor->type == ComponentType::int8 || accessor->type == ComponentType::int16) {
    return fail(ErrorCode::bad_format, "is used for indices, but is not SCALAR of an unsigned type", accessor->where);
  }
  if (!budget.take(accessor->count * kBytesEach)) return unfolds_too_far(data, "the primitives", where);
  out.resize(accessor->count);
  gather_bits(*accessor, {}, accessor->count, out.data(), 1, {});
  const auto most = std::max_element(out.begin(), out.end());
  if (most != out.end() && *most >= vertices) {
    return fail(ErrorCode::bad_format,
                fmt::format("index {} is {}, the primitive has {} vertices", most - out.begin(), *most, vertices),
                accessor->where);
  }
  return out;
}

std::vector<Triangle> to_triangles(const std::vector<std::uint32_t>& indices, std::uint64_t mode,
                                   const std::string& where, std::vector<std::string>& warnings) {
  std::vector<Triangle> out;
  const std::size_t n = indices.size();
  if (mode == kTriangles) {
    out.resize(n / 3);
    if (n >= 3) std::memcpy(out.data(), indices.data(), out.size() * sizeof(Triangle));
    if (n % 3 != 0)
      warnings.push_back(fmt::format("{}: {} corners are no multiple of 3; the last were left out", where, n));
    return out;
  }
  out.reserve(n < 3 ? 0 : n - 2);
  for (std::size_t i = 0; i + 2 < n; ++i) {
    // glTF 2.0, 3.7.2.1: strips turn every second triangle, fans keep the first vertex last.
    const Triangle t = mode == kStrip ? Triangle{indices[i], indices[i + 1 + i % 2], indices[i + 2 - i % 2]}
                                      : Triangle{indices[i + 1], indices[i + 2], indices[0]};
    const bool stitching = mode == kStrip && (t[0] == t[1] || t[1] == t[2] || t[0] == t[2]);
    if (!stitching) out.push_back(t);
  }
  return out;
}

// Renumbers the triangles to the vertices that they use. Costs the smaller of sorting the corners and marking all
// vertices.
void compact(PrimitiveSource& source) {
  const std::size_t all = source.positions.count, corners = source.triangles.size() * 3;
  std::vector<std::uint32_t>& used = source.vertices;
  if (corners / 8 < all / 64) {  // few triangles on a large shared buffer
    used.reserve(corners);
    for (const Triangle& t : source.triangles) used.insert(used.end(), t.begin(), t.end());
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    for (Triangle& t : source.triangles) {
      for (std::uint32_t& v : t) {
        v = static_cast<std::uint32_t>(std::lower_bound(used.begin(), used.end(), v) - used.begin());
      }
    }
    source.vertex_count = used.size();
    return;
  }
  std::vector<std::uint32_t> number(all, 0);
  for (const Triangle& t : source.triangles) {
    for (const std::uint32_t v : t) number[v] = 1;
  }
  std::uint32_t count = 0;
  for (std::uint32_t& n : number) n = n != 0 ? count++ : kNone;
  source.vertex_count = count;
  if (count == all) return;
  used.reserve(count);
  for (std::uint32_t v = 0; v < all; ++v) {
    if (number[v] != kNone) used.push_back(v);
  }
  for (Triangle& t : source.triangles) {
    for (std::uint32_t& v : t) v = number[v];
  }
}

Result<void> check_counts(const PrimitiveSource& source) {
  const auto check = [&](const NamedAccessors& list) -> Result<void> {
    for (const auto& [name, accessor] : list) {
      if (accessor.count != source.positions.count) {
        return fail(ErrorCode::bad_format,
                    fmt::format("{} has {} elements, POSITION has {}", name, accessor.count, source.positions.count),
                    accessor.where);
      }
    }
    return {};
  };
  if (const auto good = check(source.attributes); !good) return good;
  for (const NamedAccessors& target : source.targets) {
    if (const auto good = check(target); !good) return good;
  }
  return {};
}

Result<void> read_targets(const Document::Data& data, const Json& primitive, const std::string& where,
                          PrimitiveSource& source, Budget& budget, std::vector<std::string>& warnings) {
  for (const Json& target : array_member(primitive, "targets")) {
    Result<NamedAccessors> list = read_named(data, target, true, where, {}, budget, warnings);
    LODESTONE_TRY(list);
    source.targets.push_back(std::move(*list));
  }
  return {};
}

}  // namespace

bool is_triangle_primitive(const Json& primitive) {
  const std::uint64_t mode = mode_of(primitive);
  return mode == kTriangles || mode == kStrip || mode == kFan;
}

bool is_draco_primitive(const Json& primitive) { return draco_extension(primitive) != nullptr; }

Result<PrimitiveSource> read_primitive(const Document::Data& data, const Json& primitive, const std::string& where,
                                       Budget& budget, DracoCache& cache, std::vector<std::string>& warnings) {
  PrimitiveSource out;
  if (const Json* material = member(primitive, "material"); material != nullptr) {
    const std::size_t count = array_member(data.json, "materials").size();
    const Result<std::size_t> index = index_member(primitive, "material", count, "materials", where);
    LODESTONE_TRY(index);
    out.material = static_cast<std::uint32_t>(*index);
  }
  const Json* attributes = member(primitive, "attributes");
  if (attributes == nullptr || !attributes->is_object()) {
    return fail(ErrorCode::bad_format, "has no attributes", where);
  }
  std::vector<std::string> done;
  std::shared_ptr<const DracoMesh> draco;
  if (const Json* extension = draco_extension(primitive); extension != nullptr) {
    Result<std::shared_ptr<const DracoMesh>> decoded = decode_view(data, *extension, where, budget, cache);
    LODESTONE_TRY(decoded);
    draco = std::move(*decoded);
    Result<NamedAccessors> list = read_draco_attributes(data, primitive, *draco, where, done);
    LODESTONE_TRY(list);
    out.attributes = std::move(*list);
  }
  Result<NamedAccessors> plain = read_named(data, *attributes, false, where, done, budget, warnings);
  LODESTONE_TRY(plain);
  for (auto& entry : *plain) out.attributes.push_back(std::move(entry));

  const auto positions = std::find_if(out.attributes.begin(), out.attributes.end(),
                                      [](const auto& entry) { return entry.first == "POSITION"; });
  if (positions == out.attributes.end()) return out;  // legal, draws nothing
  out.positions = std::move(positions->second);
  out.attributes.erase(positions);
  if (const auto good = read_targets(data, primitive, where, out, budget, warnings); !good) return fail(good.error());
  if (const auto good = check_counts(out); !good) return fail(good.error());

  std::vector<std::uint32_t> indices;
  if (draco != nullptr) {
    if (!budget.take(draco->indices.size() * (sizeof(std::uint32_t) + sizeof(Triangle) / 3))) {
      return unfolds_too_far(data, "the primitives", where);
    }
    indices = draco->indices;
  } else {
    Result<std::vector<std::uint32_t>> list = read_indices(data, primitive, out.positions.count, where, budget);
    LODESTONE_TRY(list);
    indices = std::move(*list);
  }
  out.triangles = to_triangles(indices, draco != nullptr ? kTriangles : mode_of(primitive), where, warnings);
  compact(out);
  return out;
}

}  // namespace lodestone::io
