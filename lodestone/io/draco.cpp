// libdraco behind plain structs. The library throws nothing of its own, but a stream that lies about its size may make
// it ask for too much memory: that is caught here.
#include "lodestone/io/draco.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <new>

#include "lodestone/base/file.h"
#include "lodestone/core/weld.h"
#include "lodestone/io/draco_detail.h"

#ifdef LODESTONE_WITH_DRACO
// The library's headers are not free of the warnings that we treat as errors.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#pragma GCC diagnostic ignored "-Wextra"
#include <draco/compression/decode.h>
#include <draco/compression/expert_encode.h>
#pragma GCC diagnostic pop
#endif

namespace lodestone::io {

#ifdef LODESTONE_WITH_DRACO

namespace {

DracoKind kind_of(draco::GeometryAttribute::Type type) {
  switch (type) {
    case draco::GeometryAttribute::POSITION:
      return DracoKind::position;
    case draco::GeometryAttribute::NORMAL:
      return DracoKind::normal;
    case draco::GeometryAttribute::COLOR:
      return DracoKind::color;
    case draco::GeometryAttribute::TEX_COORD:
      return DracoKind::texcoord;
    default:
      return DracoKind::generic;
  }
}

draco::GeometryAttribute::Type type_of(DracoKind kind) {
  switch (kind) {
    case DracoKind::position:
      return draco::GeometryAttribute::POSITION;
    case DracoKind::normal:
      return draco::GeometryAttribute::NORMAL;
    case DracoKind::color:
      return draco::GeometryAttribute::COLOR;
    case DracoKind::texcoord:
      return draco::GeometryAttribute::TEX_COORD;
    case DracoKind::generic:
      break;
  }
  return draco::GeometryAttribute::GENERIC;
}

// The component types that we share with the library; false for the others (64 bits, bool), which are read as float.
bool plain_type(draco::DataType type, ComponentType& out) {
  switch (type) {
    case draco::DT_INT8:
      out = ComponentType::int8;
      return true;
    case draco::DT_UINT8:
      out = ComponentType::uint8;
      return true;
    case draco::DT_INT16:
      out = ComponentType::int16;
      return true;
    case draco::DT_UINT16:
      out = ComponentType::uint16;
      return true;
    case draco::DT_INT32:
      out = ComponentType::int32;
      return true;
    case draco::DT_UINT32:
      out = ComponentType::uint32;
      return true;
    case draco::DT_FLOAT32:
      out = ComponentType::float32;
      return true;
    default:
      return false;
  }
}

draco::DataType draco_type(ComponentType type) {
  switch (type) {
    case ComponentType::int8:
      return draco::DT_INT8;
    case ComponentType::uint8:
      return draco::DT_UINT8;
    case ComponentType::int16:
      return draco::DT_INT16;
    case ComponentType::uint16:
      return draco::DT_UINT16;
    case ComponentType::int32:
      return draco::DT_INT32;
    case ComponentType::uint32:
      return draco::DT_UINT32;
    case ComponentType::float32:
    case ComponentType::float64:
      break;
  }
  return draco::DT_FLOAT32;
}

Result<DracoAttribute> read_attribute(const draco::PointAttribute& in, std::size_t points, const std::string& where) {
  DracoAttribute out;
  out.id = in.unique_id();
  out.kind = kind_of(in.attribute_type());
  out.components = static_cast<std::size_t>(in.num_components());
  out.normalized = in.normalized();
  const bool plain = plain_type(in.data_type(), out.type);
  if (!plain) out.type = ComponentType::float32;
  const std::size_t size = out.components * size_of(out.type);
  auto values = std::make_shared<std::vector<std::byte>>(points * size);
  for (std::size_t p = 0; p < points; ++p) {
    const draco::AttributeValueIndex value = in.mapped_index(draco::PointIndex(static_cast<std::uint32_t>(p)));
    if (value.value() >= in.size()) {
      return fail(ErrorCode::bad_format,
                  fmt::format("a Draco attribute has {} values, point {} names {}", in.size(), p, value.value()),
                  where);
    }
    std::byte* to = values->data() + p * size;
    if (plain) {
      std::memcpy(to, in.GetAddress(value), size);
    } else if (!in.ConvertValue<float>(value, static_cast<std::int8_t>(out.components), reinterpret_cast<float*>(to))) {
      return fail(ErrorCode::unsupported, "a Draco attribute of a type that is not read", where);
    }
  }
  out.values = std::move(values);
  return out;
}

Result<DracoMesh> to_plain(const draco::Mesh& in, const std::string& where) {
  DracoMesh out;
  out.points = in.num_points();
  out.indices.reserve(std::size_t{in.num_faces()} * 3);
  for (std::uint32_t f = 0; f < in.num_faces(); ++f) {
    for (const draco::PointIndex& p : in.face(draco::FaceIndex(f))) {
      if (p.value() >= out.points) {
        return fail(ErrorCode::bad_format,
                    fmt::format("Draco face {} names point {}, there are {}", f, p.value(), out.points), where);
      }
      out.indices.push_back(p.value());
    }
  }
  for (int i = 0; i < in.num_attributes(); ++i) {
    Result<DracoAttribute> attribute = read_attribute(*in.attribute(i), out.points, where);
    LODESTONE_TRY(attribute);
    out.attributes.push_back(std::move(*attribute));
  }
  return out;
}

}  // namespace

bool has_draco() { return true; }

Result<DracoMesh> decode_draco(std::string_view bytes, const std::string& where) try {
  draco::DecoderBuffer buffer;
  buffer.Init(bytes.data(), bytes.size());
  const auto kind = draco::Decoder::GetEncodedGeometryType(&buffer);
  if (kind.ok() && kind.value() == draco::POINT_CLOUD) {
    return fail(ErrorCode::empty, "the Draco stream holds a point cloud, no triangle", where);
  }
  draco::Decoder decoder;
  auto mesh = decoder.DecodeMeshFromBuffer(&buffer);
  if (!mesh.ok()) {
    return fail(ErrorCode::bad_format,
                fmt::format("the Draco stream cannot be decoded: {}", mesh.status().error_msg_string()), where,
                "is it cut off?");
  }
  return to_plain(*mesh.value(), where);
} catch (const std::bad_alloc&) {
  return fail(ErrorCode::bad_format,
              fmt::format("a Draco stream of {} bytes asks for more memory than there is", bytes.size()), where,
              "is it broken?");
} catch (const std::length_error&) {
  return fail(ErrorCode::bad_format, fmt::format("a Draco stream of {} bytes names an impossible size", bytes.size()),
              where, "is it broken?");
}

Result<DracoEncoded> encode_draco(const DracoMesh& in, bool keep_order) {
  draco::Mesh mesh;
  mesh.set_num_points(static_cast<std::uint32_t>(in.points));
  mesh.SetNumFaces(in.indices.size() / 3);
  for (std::size_t f = 0; f < in.indices.size() / 3; ++f) {
    draco::Mesh::Face face;
    for (std::size_t c = 0; c < 3; ++c) face[c] = draco::PointIndex(in.indices[f * 3 + c]);
    mesh.SetFace(draco::FaceIndex(static_cast<std::uint32_t>(f)), face);
  }
  for (const DracoAttribute& attribute : in.attributes) {
    const std::size_t size = attribute.components * size_of(attribute.type);
    draco::GeometryAttribute description;
    description.Init(type_of(attribute.kind), nullptr, static_cast<std::uint8_t>(attribute.components),
                     draco_type(attribute.type), attribute.normalized, static_cast<std::int64_t>(size), 0);
    const int id = mesh.AddAttribute(description, true, static_cast<std::uint32_t>(in.points));
    mesh.attribute(id)->set_unique_id(attribute.id);
    mesh.attribute(id)->buffer()->Write(0, attribute.values->data(), in.points * size);
  }
  draco::ExpertEncoder encoder(mesh);
  encoder.SetEncodingMethod(keep_order ? draco::MESH_SEQUENTIAL_ENCODING : draco::MESH_EDGEBREAKER_ENCODING);
  encoder.SetSpeedOptions(3, 3);
  encoder.SetTrackEncodedProperties(true);
  draco::EncoderBuffer buffer;
  const draco::Status status = encoder.EncodeToBuffer(&buffer);
  if (!status.ok()) {
    return fail(ErrorCode::bad_argument, fmt::format("Draco cannot encode a primitive: {}", status.error_msg_string()));
  }
  DracoEncoded out;
  out.bytes.assign(buffer.data(), buffer.size());
  out.points = encoder.num_encoded_points();
  out.triangles = encoder.num_encoded_faces();
  return out;
}

#else

namespace {
tl::unexpected<Error> missing(const std::string& where) {
  return fail(ErrorCode::unsupported, "Draco is not in this build", where,
              "build with -DLODESTONE_WITH_DRACO=ON (Debian: libdraco-dev)");
}
}  // namespace

bool has_draco() { return false; }
Result<DracoMesh> decode_draco(std::string_view, const std::string& where) { return missing(where); }
Result<DracoEncoded> encode_draco(const DracoMesh&, bool) { return missing({}); }

#endif

namespace {

// Names and meanings for attributes that have only a kind.
struct Naming {
  std::string name;
  Semantic semantic;
  std::uint32_t set;
};

Naming name_attribute(const DracoAttribute& attribute, std::uint32_t counts[5]) {
  const std::uint32_t n = counts[static_cast<int>(attribute.kind)]++;
  switch (attribute.kind) {
    case DracoKind::normal:
      if (n == 0 && attribute.components == 3) return {"NORMAL", Semantic::normal, 0};
      break;
    case DracoKind::color:
      if (attribute.components >= 3 && attribute.components <= 4)
        return {fmt::format("COLOR_{}", n), Semantic::color, n};
      break;
    case DracoKind::texcoord:
      if (attribute.components == 2) return {fmt::format("TEXCOORD_{}", n), Semantic::uv, n};
      break;
    default:
      break;
  }
  const bool integer = attribute.type != ComponentType::float32 && !attribute.normalized;
  return {fmt::format("_GENERIC_{}", attribute.id), integer ? Semantic::categorical : Semantic::generic, 0};
}

template <class T>
float number(const std::byte* at, bool normalized) {
  T value;
  std::memcpy(&value, at, sizeof value);
  const double top = static_cast<double>(std::numeric_limits<T>::max());
  return static_cast<float>(normalized ? std::max(-1.0, static_cast<double>(value) / top) : static_cast<double>(value));
}

float as_float(const std::byte* at, const DracoAttribute& a) {
  switch (a.type) {
    case ComponentType::int8:
      return number<std::int8_t>(at, a.normalized);
    case ComponentType::uint8:
      return number<std::uint8_t>(at, a.normalized);
    case ComponentType::int16:
      return number<std::int16_t>(at, a.normalized);
    case ComponentType::uint16:
      return number<std::uint16_t>(at, a.normalized);
    case ComponentType::int32:
      return number<std::int32_t>(at, a.normalized);
    case ComponentType::uint32:
      return number<std::uint32_t>(at, a.normalized);
    default:
      return number<float>(at, false);
  }
}

std::uint32_t as_bits(const std::byte* at, const DracoAttribute& a) {
  switch (a.type) {
    case ComponentType::int8:
      return static_cast<std::uint32_t>(static_cast<std::int8_t>(*at));
    case ComponentType::uint8:
      return static_cast<std::uint32_t>(*at);
    case ComponentType::int16: {
      std::int16_t value;
      std::memcpy(&value, at, sizeof value);
      return static_cast<std::uint32_t>(value);
    }
    case ComponentType::uint16: {
      std::uint16_t value;
      std::memcpy(&value, at, sizeof value);
      return value;
    }
    default: {
      std::uint32_t value;
      std::memcpy(&value, at, sizeof value);
      return value;
    }
  }
}

AttributeStream to_stream(const DracoAttribute& a, const Naming& naming, std::size_t points) {
  AttributeStream stream =
      make_stream(naming.name, naming.semantic, static_cast<std::uint32_t>(a.components), a.type, a.normalized, points);
  stream.set = naming.set;
  const std::size_t size = size_of(a.type);
  const auto fill = [&](auto& values) {
    using T = typename std::remove_reference_t<decltype(values)>::value_type;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const std::byte* at = a.values->data() + i * size;
      if constexpr (std::is_same_v<T, std::uint32_t>) {
        values[i] = as_bits(at, a);
      } else {
        values[i] = static_cast<T>(as_float(at, a));
      }
    }
  };
  std::visit(fill, stream.values);
  return stream;
}

Result<Mesh> to_mesh(const DracoMesh& in, const std::string& where) {
  Mesh mesh;
  std::uint32_t counts[5] = {};
  for (const DracoAttribute& a : in.attributes) {
    if (a.kind != DracoKind::position || a.components != 3 || !mesh.positions.empty()) {
      mesh.attributes.push_back(to_stream(a, name_attribute(a, counts), in.points));
      continue;
    }
    const std::size_t size = size_of(a.type);
    mesh.positions.resize(in.points);
    for (std::size_t p = 0; p < in.points; ++p) {
      for (std::size_t c = 0; c < 3; ++c) mesh.positions[p][c] = as_float(a.values->data() + (p * 3 + c) * size, a);
      if (!is_finite(mesh.positions[p])) {
        return fail(ErrorCode::bad_format, fmt::format("the position of point {} is not finite", p), where);
      }
    }
  }
  if (mesh.positions.size() != in.points) return fail(ErrorCode::bad_format, "the Draco mesh has no positions", where);
  mesh.triangles.resize(in.indices.size() / 3);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    mesh.triangles[t] = {in.indices[t * 3], in.indices[t * 3 + 1], in.indices[t * 3 + 2]};
  }
  return mesh;
}

}  // namespace

Result<Model> read_drc(const std::filesystem::path& path, Task task) {
  const Result<std::string> bytes = read_file(path);
  LODESTONE_TRY(bytes);
  return read_drc_bytes(*bytes, path.string(), task);
}

Result<Model> read_drc_bytes(std::string_view bytes, const std::string& name, Task task) {
  if (bytes.empty()) return fail(ErrorCode::bad_format, "the file is empty", name);
  const Result<DracoMesh> decoded = decode_draco(bytes, name);
  LODESTONE_TRY(decoded);
  if (task.cancelled()) return cancelled_error("reading");
  Result<Mesh> mesh = to_mesh(*decoded, name);
  LODESTONE_TRY(mesh);
  if (mesh->triangles.empty()) return fail(ErrorCode::empty, "no triangle in the file", name);
  const std::size_t points = decoded->points, triangles = mesh->triangles.size();
  Result<Mesh> welded = weld_exact(std::move(*mesh), task);
  LODESTONE_TRY(welded);
  Model model = make_model(std::move(*welded));
  model.file_vertices = points;
  model.file_triangles = triangles;
  return model;
}

}  // namespace lodestone::io
