#include "lodestone/core/corner_normals.h"

#include <cmath>

#include "lodestone/math/triangle.h"

namespace lodestone {

namespace {

constexpr float kFlatCosine = 0.9998F;  // about one degree: exporters round normals to bytes

Vec3f face_normal(const Mesh& mesh, std::size_t triangle) {
  const Triangle v = mesh.vertices_of(triangle);
  return to_float(normalized(scaled_normal(to_double(mesh.positions[v[0]]), to_double(mesh.positions[v[1]]),
                                           to_double(mesh.positions[v[2]]))));
}

// The values of the first such stream that are floats; const if the mesh is.
template <class AnyMesh>
auto float_stream(AnyMesh& mesh, Semantic semantic, std::uint32_t components)
    -> decltype(std::get_if<std::vector<float>>(&mesh.attributes[0].values)) {
  for (auto& stream : mesh.attributes) {
    if (stream.semantic == semantic && stream.components == components) {
      return std::get_if<std::vector<float>>(&stream.values);
    }
  }
  return nullptr;
}

Vec3f normal_at(const std::vector<float>& normals, std::uint32_t wedge) {
  return {normals[wedge * 3], normals[wedge * 3 + 1], normals[wedge * 3 + 2]};
}

bool is_flat_shaded(const Mesh& mesh, const std::vector<float>& normals, std::uint32_t triangle) {
  const Vec3f n = face_normal(mesh, triangle);
  for (const std::uint32_t w : mesh.triangles[triangle]) {
    if (!(dot(normal_at(normals, w), n) >= kFlatCosine)) return false;
  }
  return true;
}

// True if the original has its normals on the other side: the back of a sheet that shares them with the front.
bool is_backward(const Mesh& mesh, const std::vector<float>& normals, std::uint32_t triangle) {
  const Vec3f n = face_normal(mesh, triangle);
  const Triangle& w = mesh.triangles[triangle];
  return dot(normal_at(normals, w[0]) + normal_at(normals, w[1]) + normal_at(normals, w[2]), n) < 0;
}

// A copy of a wedge's tuples at the end of all streams.
std::uint32_t add_wedge(Mesh& mesh, std::uint32_t from) {
  if (mesh.wedge_vertex.empty()) {
    mesh.wedge_vertex.resize(mesh.positions.size());
    for (std::uint32_t v = 0; v < mesh.wedge_vertex.size(); ++v) mesh.wedge_vertex[v] = v;
  }
  const auto wedge = static_cast<std::uint32_t>(mesh.wedge_vertex.size());
  mesh.wedge_vertex.push_back(mesh.wedge_vertex[from]);
  for (AttributeStream& stream : mesh.attributes) {
    std::visit(
        [&](auto& values) {
          for (std::size_t k = 0; k < stream.components; ++k) values.push_back(values[from * stream.components + k]);
        },
        stream.values);
  }
  return wedge;
}

// Gives a corner the wanted normal: in place while nobody else uses its wedge, else through a new wedge.
void set_corner_normal(Mesh& mesh, std::size_t triangle, std::size_t corner, Vec3f normal,
                       std::vector<std::uint32_t>& users) {
  std::uint32_t wedge = mesh.triangles[triangle][corner];
  if (users[wedge] > 1) {
    --users[wedge];
    wedge = add_wedge(mesh, wedge);
    users.push_back(1);
    mesh.triangles[triangle][corner] = wedge;
  }
  std::vector<float>& normals = *float_stream(mesh, Semantic::normal, 3);
  for (std::size_t k = 0; k < 3; ++k) normals[wedge * 3 + k] = normal[k];
}

// Wedges with `kept` set stay as they are.
void make_tangents_orthogonal(Mesh& mesh, const std::vector<std::uint8_t>& kept) {
  std::vector<float>* tangents = float_stream(mesh, Semantic::tangent, 4);
  const std::vector<float>* normals = float_stream(mesh, Semantic::normal, 3);
  if (tangents == nullptr || normals == nullptr) return;
  for (std::uint32_t w = 0; w < mesh.wedge_count(); ++w) {
    if (w < kept.size() && kept[w] != 0) continue;  // wedges added above are past the end
    float* t = tangents->data() + w * 4;
    const Vec3f n = normal_at(*normals, w), before{t[0], t[1], t[2]};
    const Vec3f straight = normalized(before - n * dot(n, before));
    if (straight == Vec3f{}) continue;
    for (std::size_t k = 0; k < 3; ++k) t[k] = straight[k];
  }
}

}  // namespace

void repair_corner_normals(const Mesh& original, const std::vector<std::uint32_t>& origin, Mesh& mesh,
                           const std::vector<std::uint8_t>& untouched) {
  const std::vector<float>* original_normals = float_stream(original, Semantic::normal, 3);
  if (original_normals == nullptr) return;
  std::vector<std::uint32_t> users(mesh.wedge_count(), 0);
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t w : t) ++users[w];
  }
  std::vector<std::uint8_t> kept(untouched.empty() ? 0 : mesh.wedge_count(), 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (untouched.empty() || untouched[origin[t]] == 0) continue;
    for (const std::uint32_t w : mesh.triangles[t]) kept[w] = 1;
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!untouched.empty() && untouched[origin[t]] != 0) continue;
    const Vec3f n = face_normal(mesh, t);
    if (n == Vec3f{}) continue;
    if (is_backward(original, *original_normals, origin[t])) continue;
    const bool flat = is_flat_shaded(original, *original_normals, origin[t]);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3f now = normal_at(*float_stream(mesh, Semantic::normal, 3), mesh.triangles[t][k]);
      const bool wrong = flat ? !(dot(now, n) >= kFlatCosine) : dot(now, n) < 0 && now != Vec3f{};
      if (wrong) set_corner_normal(mesh, t, k, n, users);
    }
  }
  make_tangents_orthogonal(mesh, kept);
}

}  // namespace lodestone
