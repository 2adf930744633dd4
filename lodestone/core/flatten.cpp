#include "lodestone/core/flatten.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lodestone {

namespace {

bool alike(const AttributeStream& a, const AttributeStream& b) {
  return a.name == b.name && a.semantic == b.semantic && a.components == b.components &&
         a.values.index() == b.values.index() && a.type == b.type && a.normalized == b.normalized;
}

const AttributeStream* find_alike(const Mesh& mesh, const AttributeStream& wanted) {
  for (const AttributeStream& s : mesh.attributes) {
    if (alike(s, wanted)) return &s;
  }
  return nullptr;
}

// Streams of the first drawn mesh that all others have, too.
std::vector<AttributeStream> common_streams(const Model& model, std::vector<std::string>& warnings) {
  std::vector<AttributeStream> out;
  const Mesh& first = model.meshes[model.instances.front().mesh];
  for (const AttributeStream& stream : first.attributes) {
    const bool everywhere = std::all_of(model.instances.begin(), model.instances.end(), [&](const Instance& i) {
      return find_alike(model.meshes[i.mesh], stream) != nullptr;
    });
    if (everywhere) {
      AttributeStream empty = stream;
      empty.present.clear();
      std::visit([](auto& values) { values.clear(); }, empty.values);
      out.push_back(std::move(empty));
    } else {
      warnings.push_back(fmt::format("attribute '{}' is not on all meshes: left out", stream.name));
    }
  }
  return out;
}

// Transposed inverse of the upper 3x3 up to a positive factor: what normals turn by.
Vec3d turn_normal(const Mat4d& t, Vec3d n) {
  const Vec3d x{t.m[0], t.m[1], t.m[2]}, y{t.m[4], t.m[5], t.m[6]}, z{t.m[8], t.m[9], t.m[10]};
  const double sign = t.determinant3() < 0 ? -1 : 1;
  return (cross(y, z) * n.x + cross(z, x) * n.y + cross(x, y) * n.z) * sign;
}

void append_values(const AttributeStream& from, const Mat4d& transform, AttributeStream& to) {
  const bool turns =
      (from.semantic == Semantic::normal || from.semantic == Semantic::tangent) && !transform.is_identity();
  std::visit(
      [&](const auto& values) {
        using Values = std::decay_t<decltype(values)>;
        auto& out = std::get<Values>(to.values);
        const std::size_t start = out.size(), n = from.components;
        out.insert(out.end(), values.begin(), values.end());
        if constexpr (std::is_same_v<Values, std::vector<float>>) {
          for (std::size_t i = start; turns && n >= 3 && i < out.size(); i += n) {
            const Vec3d v{out[i], out[i + 1], out[i + 2]};
            const Vec3d u =
                normalized(from.semantic == Semantic::normal ? turn_normal(transform, v) : transform.direction(v));
            for (std::size_t k = 0; k < 3; ++k) out[i + k] = static_cast<float>(u[k]);
          }
        }
      },
      from.values);
}

void append_instance(const Model& model, const Instance& instance, Mesh& out) {
  const Mesh& mesh = model.meshes[instance.mesh];
  const auto first_vertex = static_cast<std::uint32_t>(out.positions.size());
  const auto first_wedge = static_cast<std::uint32_t>(out.wedge_vertex.size());
  const auto first_group = static_cast<std::uint32_t>(out.groups.size());
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    out.positions.push_back(to_float(instance.transform.point(mesh.position(v)) - out.offset));
  }
  for (std::uint32_t w = 0; w < mesh.wedge_count(); ++w) out.wedge_vertex.push_back(first_vertex + mesh.vertex_of(w));
  const bool mirrored = instance.transform.determinant3() < 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    Triangle w = mesh.triangles[t];
    for (std::uint32_t& c : w) c += first_wedge;
    if (mirrored) std::swap(w[1], w[2]);
    out.triangles.push_back(w);
    out.face_group.push_back(first_group + mesh.group_of(t));
  }
  if (mesh.groups.empty()) out.groups.push_back({});
  for (const FaceGroup& group : mesh.groups) {
    out.groups.push_back(group);
    if (out.groups.back().name.empty()) out.groups.back().name = instance.name;
  }
  for (AttributeStream& stream : out.attributes) append_values(*find_alike(mesh, stream), instance.transform, stream);
}

}  // namespace

Mesh flatten_to_mesh(const Model& model, std::vector<std::string>& warnings) {
  const Instance& first = model.instances.front();
  if (model.instances.size() == 1 && first.transform.is_identity()) return model.meshes[first.mesh];
  Mesh out;
  out.name = first.name;
  out.attributes = common_streams(model, warnings);
  const Mesh& mesh = model.meshes[first.mesh];
  const Box3d box = bounds_of(model);
  const Vec3d size = box.size(), center = box.center();
  // Far from the origin, measured by its own size, floats would spoil the shape.
  const double far = std::max({std::abs(center.x), std::abs(center.y), std::abs(center.z)});
  const bool shift = mesh.offset != Vec3d{} || far > 256 * std::max({size.x, size.y, size.z});
  if (shift) out.offset = {std::floor(center.x), std::floor(center.y), std::floor(center.z)};
  for (const Instance& instance : model.instances) append_instance(model, instance, out);
  return out;
}

Model flattened(Model model, std::vector<std::string>& warnings) {
  const bool one = model.meshes.size() == 1 && model.instances.size() == 1 && model.instances[0].mesh == 0 &&
                   model.instances[0].transform.is_identity();
  if (one && !model.document) return model;
  Model out = make_model(flatten_to_mesh(model, warnings));
  out.materials = std::move(model.materials);
  out.meters_per_unit = model.meters_per_unit;
  out.gltf_axes = model.gltf_axes;
  out.uv_origin_top = model.uv_origin_top;
  out.file_vertices = model.file_vertices;
  out.file_triangles = model.file_triangles;
  out.files = std::move(model.files);
  return out;
}

}  // namespace lodestone
