#include "lodestone/core/tangents.h"

#include <algorithm>
#include <cmath>

namespace lodestone {

namespace {

std::vector<float>* floats_of(Mesh& mesh, Semantic semantic, std::uint32_t components) {
  for (AttributeStream& stream : mesh.attributes) {
    if (stream.semantic == semantic && stream.set == 0 && stream.components == components) {
      return std::get_if<std::vector<float>>(&stream.values);
    }
  }
  return nullptr;
}

// The direction in which u grows over a triangle, and its sign against a mirrored texture; zero where UVs are flat.
struct Flow {
  Vec3d u;
  double handedness = 1;
};
Flow flow_of(const Vec3d& e1, const Vec3d& e2, const float* a, const float* b, const float* c) {
  const double du1 = double{b[0]} - a[0], dv1 = double{b[1]} - a[1], du2 = double{c[0]} - a[0],
               dv2 = double{c[1]} - a[1];
  const double det = du1 * dv2 - du2 * dv1;
  if (!(std::abs(det) > 0) || !std::isfinite(det)) return {};
  const Vec3d u = (e1 * dv2 - e2 * dv1) * (1 / det);
  const double l = length(u);
  if (!(l > 0) || !std::isfinite(l)) return {};
  // v counts downwards, so a texture that is not mirrored winds the other way than its triangle.
  return {u * (1 / l), det < 0 ? 1.0 : -1.0};
}

}  // namespace

void rebuild_tangents(Mesh& mesh) {
  std::vector<float>* tangents = floats_of(mesh, Semantic::tangent, 4);
  const std::vector<float>* normals = floats_of(mesh, Semantic::normal, 3);
  const std::vector<float>* uv = floats_of(mesh, Semantic::uv, 2);
  if (tangents == nullptr || normals == nullptr || uv == nullptr) return;
  std::vector<Vec3d> sum(mesh.wedge_count());
  std::vector<double> sign(mesh.wedge_count(), 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& w = mesh.triangles[t];
    const Triangle v = mesh.vertices_of(t);
    Vec3d p[3];
    for (std::size_t k = 0; k < 3; ++k) p[k] = to_double(mesh.positions[v[k]]);
    const Flow flow =
        flow_of(p[1] - p[0], p[2] - p[0], uv->data() + 2 * w[0], uv->data() + 2 * w[1], uv->data() + 2 * w[2]);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d a = p[(k + 1) % 3] - p[k], b = p[(k + 2) % 3] - p[k];
      const double lengths = length(a) * length(b);
      // 1 - cosine stands for the angle: it grows with it, and needs no library that differs between machines.
      const double weight = lengths > 0 ? 1 - dot(a, b) / lengths : 0;
      sum[w[k]] += flow.u * weight;
      sign[w[k]] += flow.handedness * weight * (length_sq(flow.u) > 0 ? 1 : 0);
    }
  }
  for (std::size_t w = 0; w < sum.size(); ++w) {
    const float* n = normals->data() + 3 * w;
    const Vec3d normal{n[0], n[1], n[2]};
    const Vec3d tangent = sum[w] - normal * dot(normal, sum[w]);
    const double l = length(tangent);
    if (!(l > 1e-12) || !std::isfinite(l)) continue;
    float* out = tangents->data() + 4 * w;
    out[0] = static_cast<float>(tangent.x / l);
    out[1] = static_cast<float>(tangent.y / l);
    out[2] = static_cast<float>(tangent.z / l);
    out[3] = sign[w] < 0 ? -1.0F : 1.0F;
  }
}

void drop_tangents(Mesh& mesh) {
  std::erase_if(mesh.attributes, [](const AttributeStream& stream) {
    return stream.semantic == Semantic::tangent || stream.semantic == Semantic::morph_tangent;
  });
}

}  // namespace lodestone
