// Turns normals of points around so that neighbours agree and the outermost look outward.
//
// Problem: a plane that was fitted to points has two normals, and only the surface as a whole tells which is outside.
// Method: H. Hoppe et al., Surface Reconstruction from Unorganized Points, 1992 [hoppe-1992]: the choice is passed on
// along a minimum spanning tree of the neighbours' graph, whose edges cost 1 - |n1 · n2|, so that it crosses bends
// last. What differs from it: docs/papers/scans.md.
// 1. costs_of(): the cost of each edge in 4096 steps, each edge once.
// 2. spanning_forest(): Kruskal's algorithm; edges are sorted by counting, Sets knows what is joined already.
// 3. adjacent_of(): neighbours in the forest as flat lists.
// 4. roots_of(): of each piece's six outermost points the one whose normal lies nearest to the axis; there it is known
//    which side is outside.
// 5. orient(): from each root along the forest; a normal that looks against the one before is turned.
// Invariants: signs change, nothing else. Edges of equal cost stay in the points' order, and all that decides runs on
// one thread: the same for any thread count. Cost: about linear in the graph's edges.
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "lodestone/base/parallel.h"
#include "lodestone/points/orient_detail.h"

namespace lodestone::points::detail {

namespace {

struct Edge {
  std::uint32_t a = 0, b = 0;
};

// Sets of points that are joined already; the one with the lowest number stands for its set.
class Sets {
 public:
  explicit Sets(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0U); }
  std::uint32_t find(std::uint32_t v) {
    while (parent_[v] != v) {
      parent_[v] = parent_[parent_[v]];
      v = parent_[v];
    }
    return v;
  }
  bool join(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    if (a == b) return false;
    parent_[std::max(a, b)] = std::min(a, b);
    return true;
  }

 private:
  std::vector<std::uint32_t> parent_;
};

constexpr std::size_t kSteps = 4096;  // that costs of edges are told apart by

// Whether an edge is taken from its other end: of two ends that name each other the lower one takes it.
bool taken_there(const Graph& graph, std::size_t point, std::uint32_t other) {
  if (other > point) return false;
  const std::uint32_t* row = graph.neighbors.data() + std::size_t{other} * graph.k;
  return std::find(row, row + graph.k, static_cast<std::uint32_t>(point)) != row + graph.k;
}

// What each place of the graph costs; kSteps where there is no edge, or one that is taken elsewhere.
std::vector<std::uint16_t> costs_of(const Graph& graph, std::span<const Vec3f> normals, const Task& task) {
  std::vector<std::uint16_t> costs(graph.neighbors.size());
  parallel_for(graph.size(), 16384, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin * graph.k; i < end * graph.k; ++i) {
      const std::uint32_t other = graph.neighbors[i];
      if (other == Graph::kNobody || taken_there(graph, i / graph.k, other)) {
        costs[i] = kSteps;
        continue;
      }
      const float cost = 1 - std::abs(dot(normals[i / graph.k], normals[other]));
      costs[i] = static_cast<std::uint16_t>(std::clamp(cost, 0.0F, 1.0F) * (kSteps - 1));
    }
  });
  return costs;
}

// For each cost the number of edges that cost less: where its edges begin in sorted order. One more at the end.
std::vector<std::uint64_t> firsts_by_cost(const std::vector<std::uint16_t>& costs) {
  std::vector<std::uint64_t> first(kSteps + 1, 0);
  for (const std::uint16_t c : costs) {
    if (c < kSteps) ++first[c + 1U];
  }
  std::partial_sum(first.begin(), first.end(), first.begin());
  return first;
}

// Kruskal: the cheapest edges that join what wasn't joined.
std::vector<Edge> spanning_forest(const Graph& graph, std::span<const Vec3f> normals, Sets& sets, const Task& task) {
  const std::vector<std::uint16_t> costs = costs_of(graph, normals, task);
  std::vector<std::uint64_t> next = firsts_by_cost(costs);
  std::vector<Edge> sorted(static_cast<std::size_t>(next.back()));
  for (std::size_t i = 0; i < costs.size(); ++i) {
    if (costs[i] == kSteps) continue;
    sorted[static_cast<std::size_t>(next[costs[i]]++)] = {static_cast<std::uint32_t>(i / graph.k), graph.neighbors[i]};
  }
  std::vector<Edge> forest;
  forest.reserve(graph.size());
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    if (i % 65536 == 0 && task.cancelled()) break;
    if (sets.join(sorted[i].a, sorted[i].b)) forest.push_back(sorted[i]);
  }
  return forest;
}

// Neighbours in the forest: those of v are list[first[v]] to list[first[v + 1] - 1].
struct Adjacent {
  std::vector<std::uint32_t> first, list;
};

Adjacent adjacent_of(const std::vector<Edge>& forest, std::size_t n) {
  Adjacent out;
  out.first.assign(n + 1, 0);
  for (const Edge& e : forest) {
    ++out.first[e.a + 1];
    ++out.first[e.b + 1];
  }
  std::partial_sum(out.first.begin(), out.first.end(), out.first.begin());
  out.list.resize(2 * forest.size());
  std::vector<std::uint32_t> next(out.first.begin(), out.first.end() - 1);
  for (const Edge& e : forest) {
    out.list[next[e.a]++] = e.b;
    out.list[next[e.b]++] = e.a;
  }
  return out;
}

// The outermost points of a piece along -x, +x, -y, +y, -z, +z; the first of equal ones.
struct Extremes {
  std::array<std::uint32_t, 6> point;
};

float along(Vec3f v, std::size_t side) { return side % 2 == 0 ? -v[side / 2] : v[side / 2]; }

struct Root {
  std::uint32_t point = 0;
  bool turn = false;  // its normal looks inward
};

// By pieces, in the order of their lowest points.
std::vector<Root> roots_of(Sets& sets, std::span<const Vec3f> positions, std::span<const Vec3f> normals) {
  std::vector<std::uint32_t> piece_of(positions.size());
  std::vector<Extremes> pieces;
  for (std::uint32_t v = 0; v < positions.size(); ++v) {
    const std::uint32_t lowest = sets.find(v);
    if (lowest == v) {
      piece_of[v] = static_cast<std::uint32_t>(pieces.size());
      pieces.push_back({{v, v, v, v, v, v}});
    }
    Extremes& piece = pieces[piece_of[lowest]];  // the lowest has come before
    for (std::size_t side = 0; side < 6; ++side) {
      if (along(positions[v], side) > along(positions[piece.point[side]], side)) piece.point[side] = v;
    }
  }
  std::vector<Root> roots;
  roots.reserve(pieces.size());
  for (const Extremes& piece : pieces) {
    Root root{piece.point[0], false};
    float clearest = -1;
    for (std::size_t side = 0; side < 6; ++side) {
      const float outward = along(normals[piece.point[side]], side);
      if (!(std::abs(outward) > clearest)) continue;
      clearest = std::abs(outward);
      root = {piece.point[side], outward < 0};
    }
    roots.push_back(root);
  }
  return roots;
}

}  // namespace

std::uint64_t orient(const Graph& graph, std::span<const Vec3f> positions, std::span<Vec3f> normals, const Task& task) {
  Sets sets(graph.size());
  const Adjacent adjacent = adjacent_of(spanning_forest(graph, normals, sets, task.part(0.6)), graph.size());
  const std::vector<Root> roots = roots_of(sets, positions, normals);
  std::vector<std::uint8_t> seen(graph.size(), 0);
  std::vector<std::uint32_t> queue;
  queue.reserve(graph.size());
  for (const Root& root : roots) {
    if (task.cancelled()) break;
    if (root.turn) normals[root.point] = -normals[root.point];
    queue.assign(1, root.point);
    seen[root.point] = 1;
    for (std::size_t i = 0; i < queue.size(); ++i) {
      const std::uint32_t v = queue[i];
      for (std::uint32_t a = adjacent.first[v]; a < adjacent.first[v + 1]; ++a) {
        const std::uint32_t other = adjacent.list[a];
        if (seen[other] != 0) continue;
        seen[other] = 1;
        if (dot(normals[v], normals[other]) < 0) normals[other] = -normals[other];
        queue.push_back(other);
      }
    }
  }
  return roots.size();
}

}  // namespace lodestone::points::detail
