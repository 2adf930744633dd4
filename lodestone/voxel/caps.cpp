#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <utility>

#include "lodestone/base/parallel.h"
#include "lodestone/voxel/caps_detail.h"

namespace lodestone::voxel::detail {

namespace {

// The first vertex at each vertex's place.
std::vector<std::uint32_t> first_at_places(const std::vector<Vec3d>& positions, const Task& task) {
  const auto key = [&](std::uint32_t v) {
    const Vec3d& p = positions[v];
    return std::array<double, 3>{p.x, p.y, p.z};
  };
  std::vector<std::uint32_t> order(positions.size());
  std::iota(order.begin(), order.end(), 0U);
  parallel_sort(order, task, [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  std::vector<std::uint32_t> first(positions.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && key(order[i]) == key(order[i - 1]);
    first[order[i]] = same ? first[order[i - 1]] : order[i];
  }
  return first;
}

struct Edge {
  std::uint32_t from, to;
  auto operator<=>(const Edge&) const = default;
};

// The edges that the surface walks more often one way than the other, as often as the ways differ, in order.
std::vector<Edge> open_edges(const spatial::Surface& surface, const Task& task) {
  const std::vector<std::uint32_t> place = first_at_places(surface.positions, task);
  struct Walk {
    Edge edge;  // from the lower to the higher
    int way;    // 1 if walked so, else -1
  };
  std::vector<Walk> walks;
  walks.reserve(surface.triangles.size() * 3);
  for (const Triangle& t : surface.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = place[t[k]], b = place[t[(k + 1) % 3]];
      if (a != b) walks.push_back({{std::min(a, b), std::max(a, b)}, a < b ? 1 : -1});
    }
  }
  parallel_sort(walks, task, [](const Walk& a, const Walk& b) { return a.edge < b.edge; });
  std::vector<Edge> open;
  for (std::size_t i = 0, end = 0; i < walks.size(); i = end) {
    int sum = 0;
    for (end = i; end < walks.size() && walks[end].edge == walks[i].edge; ++end) sum += walks[end].way;
    const Edge& e = walks[i].edge;
    open.insert(open.end(), static_cast<std::size_t>(std::abs(sum)), sum > 0 ? e : Edge{e.to, e.from});
  }
  std::sort(open.begin(), open.end());
  return open;
}

// A loop from `begin` to `end` of the path, cut in halves: triangles against the loop's way.
void cap(const std::vector<std::uint32_t>& path, std::size_t begin, std::size_t last, std::vector<Triangle>& out) {
  if (last - begin < 2) return;
  const std::size_t middle = begin + (last - begin) / 2;
  out.push_back({path[begin], path[last], path[middle]});
  cap(path, begin, middle, out);
  cap(path, middle, last, out);
}

}  // namespace

std::vector<Triangle> caps_of(const spatial::Surface& surface, const Task& task) {
  const std::vector<Edge> edges = open_edges(surface, task);
  std::vector<std::uint32_t> first(surface.positions.size() + 1,
                                   0);  // of the edges from a vertex; moves as they are used
  for (const Edge& e : edges) ++first[e.from];
  exclusive_scan(first);
  // As many edges lead to a vertex as from it, so a walk can always go on until it meets itself: that is a loop.
  std::vector<Triangle> out;
  std::vector<std::uint32_t> path;
  std::vector<std::uint32_t> place_on_path(surface.positions.size(), 0);  // and one more; 0 = not on it
  for (const Edge& start : edges) {
    while (first[start.from] < edges.size() && edges[first[start.from]].from == start.from) {
      path.assign(1, start.from);
      place_on_path[start.from] = 1;
      while (!path.empty()) {
        const std::uint32_t here = path.back();
        if (first[here] >= edges.size() || edges[first[here]].from != here) break;
        const std::uint32_t next = edges[first[here]++].to;
        if (place_on_path[next] == 0) {
          path.push_back(next);
          place_on_path[next] = static_cast<std::uint32_t>(path.size());
          continue;
        }
        const std::size_t begin = place_on_path[next] - 1;
        cap(path, begin, path.size() - 1, out);
        while (path.size() > begin + 1) {
          place_on_path[path.back()] = 0;
          path.pop_back();
        }
      }
      for (const std::uint32_t v : path) place_on_path[v] = 0;
    }
  }
  return out;
}

}  // namespace lodestone::voxel::detail
