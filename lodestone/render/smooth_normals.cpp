#include "lodestone/render/smooth_normals_detail.h"

#include <algorithm>

#include "lodestone/base/parallel.h"
#include "lodestone/math/triangle.h"

namespace lodestone::render::detail {

namespace {

constexpr std::size_t kChunk = 16384;
constexpr float kCreaseCosine = 0.642788F;  // 50 degrees
constexpr std::uint32_t kMostFaces = 64;

// The triangles at each vertex: list[first[v] .. first[v + 1]).
struct FacesAt {
  std::vector<std::uint32_t> first, list;
};

FacesAt faces_at_vertices(const spatial::Surface& surface) {
  FacesAt at;
  at.first.assign(surface.positions.size() + 1, 0);
  for (const Triangle& t : surface.triangles) {
    for (const std::uint32_t v : t) ++at.first[v];
  }
  exclusive_scan(at.first);
  at.list.resize(surface.triangles.size() * 3);
  std::vector<std::uint32_t> next(at.first.begin(), at.first.end() - 1);
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
    for (const std::uint32_t v : surface.triangles[t]) at.list[next[v]++] = t;
  }
  return at;
}

// A face's normal, and how much of it goes to each corner.
struct Face {
  Vec3f normal;
  Corners<float> weight;
};

// `size_sq`: the model's diagonal squared, which makes the weights free of its unit.
Face face_of(const spatial::Surface& surface, std::size_t triangle, double size_sq) {
  const auto [a, b, c] = surface.corners(triangle);
  const Vec3d sides[3] = {b - a, c - b, a - c};
  const Vec3d n = cross(sides[0], c - a);
  const double twice_area = length(n);
  Face face{to_float(normalized(n)), {}};
  if (!is_finite(face.normal)) face.normal = {};
  for (std::size_t k = 0; k < 3; ++k) {
    // The sine of the angle over the product of the lengths of the two sides.
    const double lengths_sq = length_sq(sides[k]) * length_sq(sides[(k + 2) % 3]);
    const double weight = lengths_sq > 0 ? twice_area / lengths_sq * size_sq : 0;
    face.weight[k] = weight > 0 ? static_cast<float>(std::min(weight, 1e30)) : 0;
  }
  return face;
}

}  // namespace

std::vector<Corners<PackedNormal>> smooth_normals(const spatial::Surface& surface, const Task& task) {
  const FacesAt at = faces_at_vertices(surface);
  std::vector<Face> faces(surface.triangles.size());
  const double size_sq = length_sq(surface.bounds.size());
  parallel_for(faces.size(), kChunk, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t t = begin; t < end; ++t) faces[t] = face_of(surface, t, size_sq);
  });
  std::vector<Corners<PackedNormal>> normals(surface.triangles.size());
  parallel_for(normals.size(), kChunk, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t t = begin; t < end; ++t) {
      const Vec3f own = faces[t].normal;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t v = surface.triangles[t][k];
        Vec3f sum{};
        if (at.first[v + 1] - at.first[v] <= kMostFaces) {
          for (std::uint32_t i = at.first[v]; i < at.first[v + 1]; ++i) {
            const std::uint32_t other = at.list[i];
            const Face& face = faces[other];
            if (!(dot(face.normal, own) >= kCreaseCosine)) continue;
            const Triangle& corners = surface.triangles[other];
            const std::size_t corner = corners[0] == v ? 0 : corners[1] == v ? 1 : 2;
            sum += face.normal * face.weight[corner];
          }
        }
        Vec3d normal = normalized(to_double(sum));
        if (normal == Vec3d{} || !is_finite(normal)) normal = to_double(own);
        normals[t][k] = pack_normal(normal);
      }
    }
  });
  return normals;
}

}  // namespace lodestone::render::detail
