#include "lodestone/core/parts.h"

#include <algorithm>
#include <numeric>

namespace lodestone {

namespace {

std::uint32_t find_root(std::vector<std::uint32_t>& parent, std::uint32_t v) {
  while (parent[v] != v) v = parent[v] = parent[parent[v]];
  return v;
}

}  // namespace

Parts parts_of(const Mesh& mesh) {
  std::vector<std::uint32_t> parent(mesh.vertex_count());
  std::iota(parent.begin(), parent.end(), 0U);
  std::vector<std::uint8_t> used(mesh.vertex_count(), 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle v = mesh.vertices_of(t);
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) continue;
    for (const std::uint32_t c : v) used[c] = 1;
    for (const std::uint32_t c : {v[1], v[2]}) {
      // The lower root stays: a part's root is its lowest vertex.
      const std::uint32_t a = find_root(parent, v[0]), b = find_root(parent, c);
      parent[std::max(a, b)] = std::min(a, b);
    }
  }
  Parts parts;
  parts.of_vertex.assign(mesh.vertex_count(), kNone);
  for (std::uint32_t v = 0; v < parent.size(); ++v) {
    if (used[v] == 0) continue;
    const std::uint32_t root = find_root(parent, v);
    parts.of_vertex[v] = root == v ? static_cast<std::uint32_t>(parts.count++) : parts.of_vertex[root];
  }
  return parts;
}

}  // namespace lodestone
