#include "lodestone/core/mesh.h"

#include "lodestone/math/triangle.h"

namespace lodestone {

Box3d bounds_of(const Mesh& mesh) {
  Box3f box;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::uint32_t v : mesh.vertices_of(t)) box.add(mesh.positions[v]);
  }
  if (box.empty()) return {};
  return {to_double(box.min) + mesh.offset, to_double(box.max) + mesh.offset};
}

double area_of(const Mesh& mesh) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle v = mesh.vertices_of(t);
    sum += length(scaled_normal(to_double(mesh.positions[v[0]]), to_double(mesh.positions[v[1]]),
                                to_double(mesh.positions[v[2]])));
  }
  return sum / 2;
}

double volume_of(const Mesh& mesh) {
  const Vec3d center = bounds_of(mesh).center() - mesh.offset;
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle v = mesh.vertices_of(t);
    const Vec3d a = to_double(mesh.positions[v[0]]) - center, b = to_double(mesh.positions[v[1]]) - center,
                c = to_double(mesh.positions[v[2]]) - center;
    sum += dot(a, cross(b, c));
  }
  return sum / 6;
}

const AttributeStream* find_stream(const Mesh& mesh, Semantic semantic, std::uint32_t set) {
  for (const AttributeStream& stream : mesh.attributes) {
    if (stream.semantic == semantic && stream.set == set) return &stream;
  }
  return nullptr;
}

}  // namespace lodestone
