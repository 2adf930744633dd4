#include <algorithm>
#include <cstdint>
#include <numeric>

#include "lodestone/voxel/coincident_vertices_detail.h"

namespace lodestone::voxel::detail {

void separate_coincident_vertices(const std::vector<Vec3f>& before, std::vector<Vec3f>& moved) {
  std::vector<std::uint32_t> order(moved.size());
  std::iota(order.begin(), order.end(), 0U);
  const auto less = [&](std::uint32_t a, std::uint32_t b) {
    const Vec3f &p = moved[a], &q = moved[b];
    if (p.x != q.x) return p.x < q.x;
    if (p.y != q.y) return p.y < q.y;
    if (p.z != q.z) return p.z < q.z;
    return a < b;
  };
  std::sort(order.begin(), order.end(), less);
  std::vector<std::uint32_t> again;
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (moved[order[i]] == moved[order[i - 1]]) again.push_back(order[i]);
  }
  for (const std::uint32_t v : again) moved[v] = before[v];
}

}  // namespace lodestone::voxel::detail
