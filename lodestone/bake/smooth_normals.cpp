#include <algorithm>
#include <cmath>

#include "lodestone/bake/smooth_normals_detail.h"
#include "lodestone/base/parallel.h"
#include "lodestone/math/triangle.h"

namespace lodestone::bake::detail {

namespace {

constexpr std::size_t kChunk = 16384;
constexpr double kCreaseCosine = 0.642788;  // 50 degrees
constexpr std::uint32_t kMostFaces = 64;

// A face's unit normal, and how much of it goes to each corner: the sine of the angle there over the product of the
// lengths of its two sides.
struct Face {
  Vec3d normal;
  std::array<double, 3> weight{};
};

// `size_sq`: that of the whole, which makes the weights free of the unit.
Face face_of(const std::array<Vec3d, 3>& p, double size_sq) {
  const Vec3d n = scaled_normal(p[0], p[1], p[2]);
  const double twice_area = length(n);
  Face face{normalized(n), {}};
  if (!is_finite(face.normal)) face.normal = {};
  for (std::size_t k = 0; k < 3; ++k) {
    const double lengths_sq = length_sq(p[(k + 1) % 3] - p[k]) * length_sq(p[(k + 2) % 3] - p[k]);
    const double weight = lengths_sq > 0 ? twice_area / lengths_sq * size_sq : 0;
    if (weight > 0) face.weight[k] = std::min(weight, 1e30);
  }
  return face;
}

// The corners at each vertex, 3 * triangle + corner: list[first[v] .. first[v + 1]).
struct CornersAt {
  std::vector<std::uint32_t> first, list;
};

CornersAt corners_at(const spatial::Surface& surface) {
  CornersAt at;
  at.first.assign(surface.positions.size() + 1, 0);
  for (const Triangle& t : surface.triangles) {
    for (const std::uint32_t v : t) ++at.first[v];
  }
  exclusive_scan(at.first);
  at.list.resize(surface.triangles.size() * 3);
  std::vector<std::uint32_t> next(at.first.begin(), at.first.end() - 1);
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
    for (std::uint32_t k = 0; k < 3; ++k) at.list[next[surface.triangles[t][k]]++] = 3 * t + k;
  }
  return at;
}

}  // namespace

std::vector<Vec3d> vertex_normals(const Mesh& mesh) {
  std::vector<Vec3d> normals(mesh.vertex_count());
  const double size_sq = length_sq(bounds_of(mesh).size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle v = mesh.vertices_of(t);
    const Face face = face_of({mesh.position(v[0]), mesh.position(v[1]), mesh.position(v[2])}, size_sq);
    for (std::size_t k = 0; k < 3; ++k) normals[v[k]] += face.normal * face.weight[k];
  }
  for (Vec3d& n : normals) {
    n = normalized(n);
    if (!is_finite(n)) n = {};
  }
  return normals;
}

std::vector<std::array<Vec3f, 3>> crease_normals(const spatial::Surface& surface, const Task& task) {
  const CornersAt at = corners_at(surface);
  std::vector<Face> faces(surface.triangles.size());
  const double size_sq = length_sq(surface.bounds.size());
  parallel_for(faces.size(), kChunk, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t t = begin; t < end; ++t) faces[t] = face_of(surface.corners(t), size_sq);
  });
  std::vector<std::array<Vec3f, 3>> normals(surface.triangles.size());
  parallel_for(normals.size(), kChunk, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t t = begin; t < end; ++t) {
      const Vec3d own = faces[t].normal;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t v = surface.triangles[t][k];
        Vec3d sum{};
        if (at.first[v + 1] - at.first[v] <= kMostFaces) {
          for (std::uint32_t i = at.first[v]; i < at.first[v + 1]; ++i) {
            const Face& other = faces[at.list[i] / 3];
            if (dot(other.normal, own) >= kCreaseCosine) sum += other.normal * other.weight[at.list[i] % 3];
          }
        }
        const Vec3d n = normalized(sum);
        normals[t][k] = to_float(n == Vec3d{} || !is_finite(n) ? own : n);
      }
    }
  });
  return normals;
}

}  // namespace lodestone::bake::detail
