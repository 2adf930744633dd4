#include "lodestone/io/gltf_geometry_detail.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "lodestone/io/draco_detail.h"
#include "lodestone/math/triangle.h"

namespace lodestone::io {

namespace {

constexpr const char* kTypes[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};

void warn_once(std::vector<std::string>& warnings, std::string text) {
  if (std::find(warnings.begin(), warnings.end(), text) == warnings.end()) warnings.push_back(std::move(text));
}

// "_QUALITY" from "quality": what the format asks of names of one's own.
std::string custom_name(std::string_view name) {
  std::string out = name.starts_with('_') ? "" : "_";
  for (char c : name) {
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
    const bool plain = (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    out += plain ? c : '_';
  }
  return out;
}

std::uint32_t largest_value(const std::vector<std::uint32_t>& values) {
  return values.empty() ? 0 : *std::max_element(values.begin(), values.end());
}

// Component types that glTF knows for attributes; others become floats where these hold the values.
bool choose_type(const AttributeStream& stream, AttributePlan& plan) {
  plan.type = stream.type;
  plan.normalized = stream.normalized;
  const auto* bits = std::get_if<std::vector<std::uint32_t>>(&stream.values);
  if (stream.semantic == Semantic::joints && bits != nullptr) {
    const std::uint32_t most = largest_value(*bits);
    if (most > 65535) return false;
    plan.type = most > 255 || stream.type != ComponentType::uint8 ? ComponentType::uint16 : ComponentType::uint8;
    return true;
  }
  if (stream.type == ComponentType::float64) plan.type = ComponentType::float32;
  if (stream.type == ComponentType::int32 || stream.type == ComponentType::uint32) {
    if (bits == nullptr || largest_value(*bits) >= (1U << 24)) return false;
    plan.type = ComponentType::float32;
  }
  return true;
}

AttributePlan meaning_of(const AttributeStream& stream, std::size_t index, std::uint32_t& uvs, std::uint32_t& colors) {
  AttributePlan plan;
  plan.stream = index;
  const std::size_t n = stream.components;
  if (stream.semantic == Semantic::normal && n == 3) {
    plan.name = "NORMAL";
    plan.type = ComponentType::float32;
  } else if (stream.semantic == Semantic::tangent && n == 4) {
    plan.name = "TANGENT";
  } else if (stream.semantic == Semantic::uv && n == 2) {
    plan.name = fmt::format("TEXCOORD_{}", uvs++);
  } else if (stream.semantic == Semantic::color && (n == 3 || n == 4)) {
    plan.name = fmt::format("COLOR_{}", colors++);
  } else if (n >= 1 && n <= 4) {
    plan.name = custom_name(stream.name);
  }
  return plan;
}

}  // namespace

std::vector<AttributePlan> plan_attributes(const Mesh& mesh, bool named, bool flip_v,
                                           std::vector<std::string>& warnings) {
  std::vector<AttributePlan> plans;
  std::uint32_t uvs = 0, colors = 0;
  for (std::size_t i = 0; i < mesh.attributes.size(); ++i) {
    const AttributeStream& stream = mesh.attributes[i];
    AttributePlan plan;
    if (named) {
      plan.stream = i;
      plan.name = stream.name;
      const bool morph = stream.semantic == Semantic::morph_position || stream.semantic == Semantic::morph_normal ||
                         stream.semantic == Semantic::morph_tangent || stream.semantic == Semantic::morph_other;
      if (morph) plan.target = stream.target;
    } else {
      plan = meaning_of(stream, i, uvs, colors);
    }
    if (plan.name.empty() || stream.components > 4 || !choose_type(stream, plan)) {
      warn_once(warnings, fmt::format("attribute '{}' has values that glTF cannot hold: left out", stream.name));
      continue;
    }
    if (!named && (stream.semantic == Semantic::normal || stream.semantic == Semantic::uv ||
                   stream.semantic == Semantic::tangent)) {
      plan.type = ComponentType::float32;
      plan.normalized = false;
    }
    if (stream.type == ComponentType::float64) {
      warn_once(warnings, fmt::format("attribute '{}' is double: stored as float", stream.name));
    }
    plan.flip_v = flip_v && stream.semantic == Semantic::uv;
    plans.push_back(std::move(plan));
  }
  return plans;
}

namespace {

// The wedges that a group uses, ascending, and its corners as places in that list.
struct GroupIndex {
  std::vector<std::uint32_t> wedges, corners;
};

GroupIndex index_group(const Mesh& mesh, std::size_t group) {
  GroupIndex out;
  std::vector<std::uint32_t> place(mesh.wedge_count(), kNone);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (mesh.group_of(t) != group) continue;
    for (const std::uint32_t w : mesh.triangles[t]) place[w] = 0;
  }
  for (std::uint32_t w = 0; w < place.size(); ++w) {
    if (place[w] == kNone) continue;
    place[w] = static_cast<std::uint32_t>(out.wedges.size());
    out.wedges.push_back(w);
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (mesh.group_of(t) != group) continue;
    for (const std::uint32_t w : mesh.triangles[t]) out.corners.push_back(place[w]);
  }
  return out;
}

// One element's numbers, whatever they are stored as.
void read_tuple(const AttributeStream& stream, std::uint32_t wedge, double* out) {
  std::visit(
      [&](const auto& values) {
        for (std::size_t k = 0; k < stream.components; ++k) {
          const auto v = values[wedge * stream.components + k];
          if constexpr (std::is_same_v<std::decay_t<decltype(v)>, std::uint32_t>) {
            out[k] = stream.type == ComponentType::int8 || stream.type == ComponentType::int16 ||
                             stream.type == ComponentType::int32
                         ? static_cast<double>(std::bit_cast<std::int32_t>(v))
                         : static_cast<double>(v);
          } else {
            out[k] = static_cast<double>(v);
          }
        }
      },
      stream.values);
}

double largest_of(ComponentType type) {
  switch (type) {
    case ComponentType::int8:
      return 127;
    case ComponentType::uint8:
      return 255;
    case ComponentType::int16:
      return 32767;
    case ComponentType::uint16:
      return 65535;
    default:
      return 1;
  }
}

template <class T>
void store(char* at, double value) {
  const auto v = static_cast<T>(value);
  std::memcpy(at, &v, sizeof(T));
}

void store_number(char* at, double value, ComponentType type, bool normalized) {
  if (type == ComponentType::float32) return store<float>(at, value);
  const double most = largest_of(type);
  const bool is_signed = type == ComponentType::int8 || type == ComponentType::int16;
  double whole = normalized ? value * most : value;
  whole = std::clamp(whole < 0 ? std::ceil(whole - 0.5) : std::floor(whole + 0.5), is_signed ? -most : 0.0, most);
  switch (type) {
    case ComponentType::int8:
      return store<std::int8_t>(at, whole);
    case ComponentType::uint8:
      return store<std::uint8_t>(at, whole);
    case ComponentType::int16:
      return store<std::int16_t>(at, whole);
    default:
      return store<std::uint16_t>(at, whole);
  }
}

// Exactly one after rounding to the stored type: the largest takes the rest.
void sum_to_one(double* weights, std::size_t n, ComponentType type) {
  double sum = 0;
  for (std::size_t k = 0; k < n; ++k) sum += weights[k];
  if (!(std::abs(sum - 1) < 0.02)) return;  // several sets share the sum, or the file had it otherwise
  const double most = largest_of(type);
  std::size_t largest = 0;
  double rounded = 0;
  for (std::size_t k = 0; k < n; ++k) {
    weights[k] /= sum;
    weights[k] = type == ComponentType::float32 ? static_cast<double>(static_cast<float>(weights[k]))
                                                : std::floor(weights[k] * most + 0.5) / most;
    if (weights[k] > weights[largest]) largest = k;
    rounded += weights[k];
  }
  weights[largest] += 1 - rounded;
}

void make_valid(const AttributeStream& stream, const AttributePlan& plan, Vec3d face_normal, double* v) {
  if (stream.semantic == Semantic::normal || stream.semantic == Semantic::tangent) {
    const double l = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    const Vec3d spare = face_normal == Vec3d{} ? Vec3d{0, 0, 1} : face_normal;
    for (std::size_t k = 0; k < 3; ++k) v[k] = l > 1e-12 ? v[k] / l : spare[k];
    if (stream.semantic == Semantic::tangent) v[3] = v[3] < 0 ? -1 : 1;
  } else if (stream.semantic == Semantic::weights) {
    sum_to_one(v, stream.components, plan.type);
  } else if (stream.semantic == Semantic::color) {
    for (std::size_t k = 0; k < stream.components; ++k) v[k] = std::clamp(v[k], 0.0, 1.0);
  }
  if (plan.flip_v) v[1] = 1 - v[1];
}

std::vector<Vec3d> face_normals_of(const Mesh& mesh, const GroupIndex& index) {
  std::vector<Vec3d> normals(index.wedges.size());
  for (std::size_t c = 0; c < index.corners.size(); c += 3) {
    Vec3d p[3];
    for (std::size_t k = 0; k < 3; ++k)
      p[k] = to_double(mesh.positions[mesh.vertex_of(index.wedges[index.corners[c + k]])]);
    const Vec3d n = normalized(scaled_normal(p[0], p[1], p[2]));
    for (std::size_t k = 0; k < 3; ++k) {
      if (normals[index.corners[c + k]] == Vec3d{}) normals[index.corners[c + k]] = n;
    }
  }
  return normals;
}

// An attribute's elements, each padded to a multiple of four bytes.
struct Column {
  std::string bytes;
  std::size_t components = 3, stride = 12;
  ComponentType type = ComponentType::float32;
  bool normalized = false;
};

Column stream_column(const Mesh& mesh, const GroupIndex& index, const AttributePlan& plan,
                     const std::vector<Vec3d>& face_normals) {
  const AttributeStream& stream = mesh.attributes[plan.stream];
  Column column;
  column.components = stream.components;
  column.type = plan.type;
  column.normalized = plan.normalized;
  const std::size_t width = size_of(plan.type);
  column.stride = (width * stream.components + 3) / 4 * 4;
  column.bytes.assign(index.wedges.size() * column.stride, '\0');
  std::vector<double> tuple(std::max<std::size_t>(4, stream.components));
  for (std::size_t i = 0; i < index.wedges.size(); ++i) {
    read_tuple(stream, index.wedges[i], tuple.data());
    make_valid(stream, plan, face_normals.empty() ? Vec3d{} : face_normals[i], tuple.data());
    for (std::size_t k = 0; k < stream.components; ++k) {
      store_number(column.bytes.data() + i * column.stride + k * width, tuple[k], plan.type, plan.normalized);
    }
  }
  return column;
}

Column position_column(const Mesh& mesh, const GroupIndex& index) {
  Column column;
  column.bytes.resize(index.wedges.size() * 12);
  for (std::size_t i = 0; i < index.wedges.size(); ++i) {
    std::memcpy(column.bytes.data() + 12 * i, &mesh.positions[mesh.vertex_of(index.wedges[i])], 12);
  }
  return column;
}

// Smallest and largest of each component of a float column, as positions must tell them.
void add_bounds(Json& accessor, const Column& column) {
  std::vector<float> low(column.components, std::numeric_limits<float>::infinity()), high(column.components);
  for (float& h : high) h = -std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i < column.bytes.size(); i += column.stride) {
    for (std::size_t k = 0; k < column.components; ++k) {
      float v = 0;
      std::memcpy(&v, column.bytes.data() + i + 4 * k, 4);
      low[k] = std::min(low[k], v);
      high[k] = std::max(high[k], v);
    }
  }
  accessor["min"] = low;
  accessor["max"] = high;
}

Json describe(const Column& column, std::size_t count, bool bounds) {
  Json accessor{{"componentType", gltf_number(column.type)}, {"count", count}, {"type", kTypes[column.components]}};
  if (column.normalized) accessor["normalized"] = true;
  if (bounds && column.type == ComponentType::float32) add_bounds(accessor, column);
  return accessor;
}

std::size_t pack_column(GltfPack& pack, std::size_t level, Column column, bool bounds) {
  const std::size_t count = column.bytes.size() / column.stride;
  Json accessor = describe(column, count, bounds);
  Json out{{"bufferView", pack.add_vertices(level, std::move(column.bytes), column.stride)}};
  out.update(accessor);
  return pack.add_accessor(std::move(out));
}

DracoKind draco_kind(Semantic semantic) {
  switch (semantic) {
    case Semantic::normal:
      return DracoKind::normal;
    case Semantic::color:
      return DracoKind::color;
    case Semantic::uv:
      return DracoKind::texcoord;
    default:
      return DracoKind::generic;
  }
}

// Without the padding that buffer views need.
std::shared_ptr<const std::vector<std::byte>> tight(const Column& column) {
  const std::size_t width = size_of(column.type) * column.components, count = column.bytes.size() / column.stride;
  auto out = std::make_shared<std::vector<std::byte>>(width * count);
  for (std::size_t i = 0; i < count; ++i)
    std::memcpy(out->data() + i * width, column.bytes.data() + i * column.stride, width);
  return out;
}

struct NamedColumn {
  std::string name;
  Semantic semantic;
  Column column;
};

// Attributes and indices as one Draco stream. Accessors tell counts and types only.
void pack_draco(GltfPack& pack, std::size_t level, const GroupIndex& index, std::vector<NamedColumn> columns,
                Json& primitive) {
  DracoMesh mesh;
  mesh.points = index.wedges.size();
  mesh.indices = index.corners;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const Column& c = columns[i].column;
    const DracoKind kind = columns[i].name == "POSITION" ? DracoKind::position : draco_kind(columns[i].semantic);
    mesh.attributes.push_back({static_cast<std::uint32_t>(i), kind, c.type, c.normalized, c.components, tight(c)});
  }
  const Result<DracoEncoded> coded = encode_draco(mesh, false);
  if (!coded) return;  // the caller falls back to plain accessors
  Json ids = Json::object(), attributes = Json::object();
  for (std::size_t i = 0; i < columns.size(); ++i) {
    ids[columns[i].name] = i;
    attributes[columns[i].name] =
        pack.add_accessor(describe(columns[i].column, coded->points, columns[i].name == "POSITION"));
  }
  primitive["attributes"] = std::move(attributes);
  primitive["indices"] = pack.add_accessor(
      {{"componentType", coded->points < 65536 ? 5123 : 5125}, {"count", coded->triangles * 3}, {"type", "SCALAR"}});
  primitive["extensions"][kDraco] = {{"bufferView", pack.add_bytes(level, coded->bytes)},
                                     {"attributes", std::move(ids)}};
}

}  // namespace

Json pack_primitive(GltfPack& pack, std::size_t level, const Mesh& mesh, std::size_t group,
                    const std::vector<AttributePlan>& plans, const Json& source) {
  const GroupIndex index = index_group(mesh, group);
  if (index.corners.empty()) return nullptr;
  Json primitive = source;
  for (const char* key : {"attributes", "indices", "targets", "mode"}) primitive.erase(key);
  if (primitive.contains("extensions")) {
    primitive["extensions"].erase(kDraco);
    if (primitive["extensions"].empty()) primitive.erase("extensions");
  }
  std::vector<NamedColumn> columns{{"POSITION", Semantic::generic, position_column(mesh, index)}};
  std::vector<Vec3d> face_normals;
  std::size_t targets = 0;
  for (const AttributePlan& plan : plans) {
    const AttributeStream& stream = mesh.attributes[plan.stream];
    if (!stream.in_group(group)) continue;
    if (plan.target != kNone) {
      targets = std::max(targets, plan.target + 1);
      continue;
    }
    if (stream.semantic == Semantic::normal && face_normals.empty()) face_normals = face_normals_of(mesh, index);
    columns.push_back({plan.name, stream.semantic, stream_column(mesh, index, plan, face_normals)});
  }
  if (pack.compression() == Compression::draco && targets == 0) {
    pack_draco(pack, level, index, columns, primitive);
    if (primitive.contains("indices")) return primitive;
  }
  Json attributes = Json::object();
  for (NamedColumn& c : columns)
    attributes[c.name] = pack_column(pack, level, std::move(c.column), c.name == "POSITION");
  primitive["attributes"] = std::move(attributes);
  const std::size_t view = pack.add_indices(level, index.corners, index.wedges.size());
  primitive["indices"] = pack.add_accessor({{"bufferView", view},
                                            {"componentType", index.wedges.size() < 65536 ? 5123 : 5125},
                                            {"count", index.corners.size()},
                                            {"type", "SCALAR"}});
  if (targets == 0) return primitive;
  Json list = Json::array();
  for (std::size_t t = 0; t < targets; ++t) {
    Json target = Json::object();
    for (const AttributePlan& plan : plans) {
      if (plan.target != t || !mesh.attributes[plan.stream].in_group(group)) continue;
      target[plan.name] = pack_column(pack, level, stream_column(mesh, index, plan, {}), plan.name == "POSITION");
    }
    list.push_back(std::move(target));
  }
  primitive["targets"] = std::move(list);
  return primitive;
}

}  // namespace lodestone::io
