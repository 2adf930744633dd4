#include "lodestone/core/adjacency.h"

#include <algorithm>

#include "lodestone/base/parallel.h"

namespace lodestone {

VertexTriangles vertex_triangles(const Mesh& mesh) {
  VertexTriangles out;
  out.first.assign(mesh.vertex_count() + 1, 0);
  const auto each = [&](auto&& use) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const Triangle v = mesh.vertices_of(t);
      use(v[0], t);
      if (v[1] != v[0]) use(v[1], t);
      if (v[2] != v[0] && v[2] != v[1]) use(v[2], t);
    }
  };
  each([&](std::uint32_t v, std::size_t) { ++out.first[v]; });
  out.triangles.resize(exclusive_scan(out.first));
  std::vector<std::uint32_t> next(out.first.begin(), out.first.end() - 1);
  each([&](std::uint32_t v, std::size_t t) { out.triangles[next[v]++] = static_cast<std::uint32_t>(t); });
  return out;
}

EdgeTriangles edge_triangles(const Mesh& mesh, const Task& task) {
  struct HalfEdge {
    std::uint64_t key;  // a << 32 | b, a < b
    std::uint32_t triangle;
  };
  std::vector<HalfEdge> sides;
  sides.reserve(mesh.triangles.size() * 3);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle v = mesh.vertices_of(t);
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(v[k], v[(k + 1) % 3]);
      sides.push_back({std::uint64_t{a} << 32 | b, static_cast<std::uint32_t>(t)});
    }
  }
  parallel_sort(sides, task, [](const HalfEdge& l, const HalfEdge& r) { return l.key < r.key; });
  EdgeTriangles out;
  out.triangles.reserve(sides.size());
  out.edges.reserve(sides.size() / 2);
  for (std::size_t i = 0; i < sides.size(); ++i) {
    if (i == 0 || sides[i].key != sides[i - 1].key) {
      out.edges.push_back({static_cast<std::uint32_t>(sides[i].key >> 32), static_cast<std::uint32_t>(sides[i].key),
                           static_cast<std::uint32_t>(i), 0});
    }
    ++out.edges.back().count;
    out.triangles.push_back(sides[i].triangle);
  }
  return out;
}

}  // namespace lodestone
