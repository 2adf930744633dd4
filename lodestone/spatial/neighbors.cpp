#include "lodestone/spatial/neighbors.h"

#include <algorithm>

namespace lodestone::spatial {

namespace {

struct HalfEdge {
  std::uint32_t higher;  // the other vertex
  std::uint32_t triangle;
  std::uint32_t side;
  bool upwards;  // walked from the lower vertex to the higher
};

}  // namespace

std::vector<std::array<std::uint32_t, 3>> triangle_neighbors(const Surface& surface) {
  const auto& triangles = surface.triangles;
  std::vector<std::array<std::uint32_t, 3>> neighbors(triangles.size(), {kNone, kNone, kNone});
  const auto is_proper = [](const Triangle& t) { return t[0] != t[1] && t[1] != t[2] && t[2] != t[0]; };
  // Sides by their lower vertex; each vertex has few.
  std::vector<std::uint32_t> first(surface.positions.size() + 1, 0);
  const auto each_side = [&](auto&& take) {
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
      const Triangle& v = triangles[t];
      if (!is_proper(v)) continue;
      for (std::uint32_t k = 0; k < 3; ++k) {
        const auto [low, high] = std::minmax(v[k], v[(k + 1) % 3]);
        take(low, HalfEdge{high, t, k, v[k] == low});
      }
    }
  };
  each_side([&](std::uint32_t low, const HalfEdge&) { ++first[low + 1]; });
  for (std::size_t v = 1; v < first.size(); ++v) first[v] += first[v - 1];
  std::vector<HalfEdge> sides(first.back());
  {
    std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
    each_side([&](std::uint32_t low, const HalfEdge& side) { sides[next[low]++] = side; });
  }
  for (std::size_t v = 0; v + 1 < first.size(); ++v) {
    const auto begin = sides.begin() + first[v], end = sides.begin() + first[v + 1];
    std::sort(begin, end, [](const HalfEdge& a, const HalfEdge& b) {
      return a.higher != b.higher ? a.higher < b.higher : a.triangle < b.triangle;
    });
    for (auto i = begin; i != end;) {
      auto j = i;
      while (j != end && j->higher == i->higher) ++j;
      if (j - i == 2 && i[0].upwards != i[1].upwards) {
        neighbors[i->triangle][i->side] = i[1].triangle;
        neighbors[i[1].triangle][i[1].side] = i->triangle;
      }
      i = j;
    }
  }
  return neighbors;
}

}  // namespace lodestone::spatial
