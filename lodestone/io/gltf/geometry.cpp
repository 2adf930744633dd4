// A mesh's groups as glTF primitives: which streams become which attributes, in which types, plain, meshopt or Draco.
//
// meaning_of() finds the attribute of a stream (choose_type(): types that glTF does not know become floats where these
// hold the values), custom_name() and make_unique() give names of one's own their underscore and keep them apart,
// new_names() keeps what the document has renamed already. pack_positions() keeps quantized positions in integers where
// all values still are such; pack_column() puts one attribute into the binary chunk. With Draco, attributes and indices
// of a group become one stream (draco_kind(), tight()), and accessors tell counts and types only; where Draco cannot
// hold a stream the group stays plain.
//
// The order of groups, streams and vertices is the mesh's, so bytes depend on the mesh and the options alone.
// O(wedges).
#include "lodestone/io/gltf/geometry_detail.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "lodestone/io/draco_detail.h"
#include "lodestone/io/gltf/names_detail.h"

namespace lodestone::io {

namespace {

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

// Names that differ only in what glTF does not allow must not fall together.
void make_unique(std::string& name, const std::vector<AttributePlan>& plans) {
  const auto taken = [&](const std::string& n) {
    return std::any_of(plans.begin(), plans.end(), [&](const AttributePlan& p) { return p.name == n; });
  };
  const std::string base = name;
  for (int i = 2; taken(name); ++i) name = fmt::format("{}_{}", base, i);
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

// What streams are called whose names the format does not allow, as in all else of the document's mesh.
std::map<std::string, std::string> new_names(const Mesh& mesh, const Json& source) {
  std::set<std::string> names = attribute_names(source);
  for (const AttributeStream& stream : mesh.attributes) names.insert(stream.name);
  return legal_names(names);
}

}  // namespace

std::vector<AttributePlan> plan_attributes(const Mesh& mesh, const Json* named, bool flip_v,
                                           std::vector<std::string>& warnings) {
  std::map<std::string, std::string> renamed;
  if (named != nullptr) renamed = new_names(mesh, *named);
  std::vector<AttributePlan> plans;
  std::uint32_t uvs = 0, colors = 0;
  for (std::size_t i = 0; i < mesh.attributes.size(); ++i) {
    const AttributeStream& stream = mesh.attributes[i];
    AttributePlan plan;
    if (named != nullptr) {
      const auto other = renamed.find(stream.name);
      plan.stream = i;
      plan.name = other != renamed.end() ? other->second : stream.name;
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
    if (named == nullptr && (stream.semantic == Semantic::normal || stream.semantic == Semantic::uv ||
                             stream.semantic == Semantic::tangent)) {
      plan.type = ComponentType::float32;
      plan.normalized = false;
    }
    if (stream.type == ComponentType::float64) {
      warn_once(warnings, fmt::format("attribute '{}' is double: stored as float", stream.name));
    }
    plan.flip_v = flip_v && stream.semantic == Semantic::uv;
    if (named == nullptr) make_unique(plan.name, plans);
    plans.push_back(std::move(plan));
  }
  return plans;
}

namespace {

std::size_t pack_column(GltfPack& pack, std::size_t level, Column column, bool bounds) {
  Json accessor = describe_column(column, column.count(), bounds);
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

// Attributes and indices as one Draco stream; accessors tell counts and types only. False if Draco cannot hold them.
bool pack_draco(GltfPack& pack, std::size_t level, const GroupIndex& index, const std::vector<NamedColumn>& columns,
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
  if (!coded) return false;
  Json ids = Json::object(), attributes = Json::object();
  for (std::size_t i = 0; i < columns.size(); ++i) {
    ids[columns[i].name] = i;
    attributes[columns[i].name] =
        pack.add_accessor(describe_column(columns[i].column, coded->points, columns[i].name == "POSITION"));
  }
  primitive["attributes"] = std::move(attributes);
  primitive["indices"] = pack.add_accessor(
      {{"componentType", coded->points < 65536 ? 5123 : 5125}, {"count", coded->triangles * 3}, {"type", "SCALAR"}});
  primitive["extensions"][kDraco] = {{"bufferView", pack.add_bytes(level, coded->bytes)},
                                     {"attributes", std::move(ids)}};
  return true;
}

// What the source's positions are stored as: quantized files have integers.
Column pack_positions(GltfPack& pack, const Mesh& mesh, const GroupIndex& index, const Json& source) {
  const Json* attributes = member(source, "attributes");
  const Json* accessor = attributes != nullptr ? pack.find_accessor_json(member(*attributes, "POSITION")) : nullptr;
  const Json* number = accessor != nullptr ? member(*accessor, "componentType") : nullptr;
  if (number == nullptr || pack.compression() == Compression::draco) {
    return position_column(mesh, index, ComponentType::float32, false);
  }
  const ComponentType type = component_type(as_uint(*number).value_or(0)).value_or(ComponentType::float32);
  const Json* normalized = member(*accessor, "normalized");
  return position_column(mesh, index, type,
                         normalized != nullptr && normalized->is_boolean() && normalized->get<bool>());
}

// Attributes that are not morph deltas, positions first.
std::vector<NamedColumn> plain_columns(GltfPack& pack, const Mesh& mesh, const GroupIndex& index,
                                       const std::vector<AttributePlan>& plans, const Json& source) {
  std::vector<NamedColumn> columns;
  columns.push_back({"POSITION", Semantic::generic, pack_positions(pack, mesh, index, source)});
  std::vector<Vec3d> face_normals;
  for (const AttributePlan& plan : plans) {
    const AttributeStream& stream = mesh.attributes[plan.stream];
    if (!stream.in_group(index.group) || plan.target != kNone) continue;
    if (stream.semantic == Semantic::normal && face_normals.empty()) face_normals = face_normals_of(mesh, index);
    columns.push_back({plan.name, stream.semantic, stream_column(mesh, index, plan, face_normals)});
  }
  return columns;
}

Json pack_targets(GltfPack& pack, std::size_t level, const Mesh& mesh, const GroupIndex& index,
                  const std::vector<AttributePlan>& plans, std::size_t targets) {
  Json list = Json::array();
  for (std::size_t t = 0; t < targets; ++t) {
    Json target = Json::object();
    for (const AttributePlan& plan : plans) {
      if (plan.target != t || !mesh.attributes[plan.stream].in_group(index.group)) continue;
      target[plan.name] = pack_column(pack, level, stream_column(mesh, index, plan, {}), plan.name == "POSITION");
    }
    list.push_back(std::move(target));
  }
  return list;
}

}  // namespace

void drop_geometry_extensions(Json& object, std::vector<std::string>& warnings) {
  if (!object.contains("extensions") || !object["extensions"].is_object()) return;
  Json& extensions = object["extensions"];
  extensions.erase(kDraco);
  for (const char* name : {"CESIUM_primitive_outline", "EXT_mesh_primitive_edge_visibility", "EXT_mesh_manifold"}) {
    if (extensions.erase(name) == 0) continue;
    warn_once(warnings, fmt::format("{} describes the original geometry: left out where that was changed", name));
  }
  if (extensions.empty()) object.erase("extensions");
}

Json pack_primitive(GltfPack& pack, std::size_t level, const Mesh& mesh, const GroupIndex& index,
                    const std::vector<AttributePlan>& plans, const Json& source, std::vector<std::string>& warnings) {
  if (index.corners.empty()) return nullptr;
  Json primitive = source;
  for (const char* key : {"attributes", "indices", "targets", "mode"}) primitive.erase(key);
  drop_geometry_extensions(primitive, warnings);
  std::size_t targets = array_member(source, "targets").size();
  for (const AttributePlan& plan : plans) {
    const bool has = plan.target != kNone && mesh.attributes[plan.stream].in_group(index.group);
    if (has) targets = std::max(targets, plan.target + 1);
  }
  std::vector<NamedColumn> columns = plain_columns(pack, mesh, index, plans, source);
  if (pack.compression() == Compression::draco) {
    if (targets == 0 && pack_draco(pack, level, index, columns, primitive)) return primitive;
    warn_once(warnings, targets > 0 ? "Draco holds no morph targets: primitives that have them are not compressed"
                                    : "Draco could not compress some primitives: they are stored plain");
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
  if (targets > 0) primitive["targets"] = pack_targets(pack, level, mesh, index, plans, targets);
  return primitive;
}

}  // namespace lodestone::io
