#include "lodestone/spatial/smooth_normals.h"

#include <algorithm>

#include "lodestone/base/parallel.h"

namespace lodestone::spatial {

namespace {

constexpr std::size_t kChunk = 16384;
constexpr float kCreaseCosine = 0.642788F;  // 50 degrees
constexpr std::uint32_t kMostFaces = 64;

// The unit normal, zero without an area, and for each corner the sine of its angle over the product of the lengths of
// its two sides. `size_sq`: that of the whole, which makes the weights free of the unit.
std::pair<Vec3d, std::array<double, 3>> weighted_normal(const std::array<Vec3d, 3>& p, double size_sq) {
  const Vec3d sides[3] = {p[1] - p[0], p[2] - p[1], p[0] - p[2]};
  const Vec3d n = cross(sides[0], p[2] - p[0]);
  const double twice_area = length(n);
  std::array<double, 3> weights{};
  for (std::size_t k = 0; k < 3; ++k) {
    const double lengths_sq = length_sq(sides[k]) * length_sq(sides[(k + 2) % 3]);
    const double weight = lengths_sq > 0 ? twice_area / lengths_sq * size_sq : 0;
    weights[k] = weight > 0 ? std::min(weight, 1e30) : 0;
  }
  const Vec3d unit = normalized(n);
  return {is_finite(unit) ? unit : Vec3d{}, weights};
}

}  // namespace

std::vector<Vec3d> vertex_normals(const Mesh& mesh) {
  std::vector<Vec3d> normals(mesh.vertex_count());
  const double size_sq = length_sq(bounds_of(mesh).size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle v = mesh.vertices_of(t);
    const auto [normal, weights] =
        weighted_normal({mesh.position(v[0]), mesh.position(v[1]), mesh.position(v[2])}, size_sq);
    for (std::size_t k = 0; k < 3; ++k) normals[v[k]] += normal * weights[k];
  }
  for (Vec3d& n : normals) {
    n = normalized(n);
    if (!is_finite(n)) n = {};
  }
  return normals;
}

CreaseNormals::CreaseNormals(const Surface& surface, const Task& task) : surface_(surface) {
  first_.assign(surface.positions.size() + 1, 0);
  for (const Triangle& t : surface.triangles) {
    for (const std::uint32_t v : t) ++first_[v];
  }
  exclusive_scan(first_);
  list_.resize(surface.triangles.size() * 3);
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
    for (const std::uint32_t v : surface.triangles[t]) list_[next[v]++] = t;
  }
  faces_.resize(surface.triangles.size());
  const double size_sq = length_sq(surface.bounds.size());
  parallel_for(faces_.size(), kChunk, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t t = begin; t < end; ++t) {
      const auto [normal, weights] = weighted_normal(surface.corners(t), size_sq);
      faces_[t].normal = to_float(normal);
      for (std::size_t k = 0; k < 3; ++k) faces_[t].weight[k] = static_cast<float>(weights[k]);
    }
  });
}

Vec3d CreaseNormals::at(std::size_t triangle, std::size_t corner) const {
  const Vec3f own = faces_[triangle].normal;
  const std::uint32_t v = surface_.triangles[triangle][corner];
  Vec3f sum{};
  if (first_[v + 1] - first_[v] <= kMostFaces) {
    for (std::uint32_t i = first_[v]; i < first_[v + 1]; ++i) {
      const std::uint32_t other = list_[i];
      const Face& face = faces_[other];
      if (!(dot(face.normal, own) >= kCreaseCosine)) continue;
      const Triangle& corners = surface_.triangles[other];
      sum += face.normal * face.weight[corners[0] == v ? 0 : corners[1] == v ? 1 : 2];
    }
  }
  const Vec3d normal = normalized(to_double(sum));
  return normal == Vec3d{} || !is_finite(normal) ? to_double(own) : normal;
}

}  // namespace lodestone::spatial
