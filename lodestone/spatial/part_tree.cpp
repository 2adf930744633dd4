// The nearest part of a mesh whose parts vanish one after another: a tree over parts, and a tree over the triangles of
// each part.
//
// 1. order_triangles() sorts triangles by part and, within a part, along a Hilbert curve [skilling-2004].
// 2. build_part_trees() puts boxes over fours of them, level by level, for each part.
// 3. build_top_tree() does the same over the boxes of the parts.
// 4. nearest() (part_tree.h) goes down the top tree first, so a part that a query must not find costs one test however
//    large it is. test_triangles() measures at the leaves, in double.
// 5. remove() empties the box of a part and renews the boxes above it.
//
// Of equally near parts the lowest number is taken: the same answers for any number of threads. Built in O(n log n), a
// removal in O(log parts).
#include "lodestone/spatial/part_tree.h"

#include <algorithm>
#include <tuple>

#include "lodestone/base/parallel.h"
#include "lodestone/spatial/hilbert.h"

namespace lodestone::spatial {

namespace {

constexpr std::size_t kChunk = 4096;

// Keys along a Hilbert curve through the box.
class Curve {
 public:
  explicit Curve(const Box3d& bounds) : low_(bounds.min) {
    const Vec3d size = bounds.size();
    const double longest = std::max({size.x, size.y, size.z});
    cells_ = longest > 0 ? 65535.0 / longest : 0;
  }
  std::uint64_t key(Vec3d p) const {
    const auto cell = [](double x) { return static_cast<std::uint32_t>(std::clamp(x, 0.0, 65535.0)); };
    const Vec3d at = (p - low_) * cells_;
    return hilbert_key(cell(at.x), cell(at.y), cell(at.z));
  }

 private:
  Vec3d low_;
  double cells_ = 0;
};

// The box of four boxes, or what there is of them.
Box3d join_four(const std::vector<Box3d>& boxes, std::size_t begin, std::size_t count, std::size_t index) {
  Box3d box;
  for (std::size_t i = index * 4; i < std::min(count, index * 4 + 4); ++i) {
    if (!boxes[begin + i].empty()) box.add(boxes[begin + i]);
  }
  return box;
}

}  // namespace

PartTree::PartTree(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles,
                   const std::vector<std::uint32_t>& part_of_vertex, std::size_t parts, const Task& task)
    : positions_(positions), triangles_(triangles) {
  order_triangles(part_of_vertex, parts, task);
  build_part_trees(task);
  build_top_tree(task);
}

void PartTree::order_triangles(const std::vector<std::uint32_t>& part_of_vertex, std::size_t parts, const Task& task) {
  struct Key {
    std::uint64_t code;
    std::uint32_t part, triangle;
  };
  Box3d bounds;
  for (const Triangle& t : triangles_) {
    for (const std::uint32_t v : t) bounds.add(positions_[v]);
  }
  const Curve curve(bounds);
  std::vector<Key> keys(triangles_.size());
  parallel_for(keys.size(), kChunk, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t t = begin; t < end; ++t) {
      const auto [a, b, c] = triangles_[t];
      keys[t] = {curve.key((positions_[a] + positions_[b] + positions_[c]) / 3.0), part_of_vertex[a],
                 static_cast<std::uint32_t>(t)};
    }
  });
  parallel_sort(keys, task,
                [](const Key& a, const Key& b) { return a.part != b.part ? a.part < b.part : a.code < b.code; });
  std::vector<Triangle> sorted;
  sorted.reserve(keys.size());
  first_.assign(parts + 1, 0);
  for (const Key& key : keys) {
    sorted.push_back(triangles_[key.triangle]);
    ++first_[key.part];
  }
  triangles_ = std::move(sorted);
  exclusive_scan(first_);
}

void PartTree::build_part_trees(const Task& task) {
  const std::size_t parts = first_.size() - 1;
  node_first_.assign(parts + 1, 0);
  for (std::uint32_t q = 0; q < parts; ++q) {
    std::size_t n = (count_of(q) + 3) / 4, sum = n;
    while (n > 1) sum += n = (n + 3) / 4;
    node_first_[q] = static_cast<std::uint32_t>(sum);
  }
  exclusive_scan(node_first_);
  nodes_.resize(node_first_.back());
  parallel_for(parts, 64, task, [&](std::size_t from, std::size_t to, std::size_t) {
    for (auto q = static_cast<std::uint32_t>(from); q < to; ++q) {
      std::size_t begin = node_first_[q], n = (count_of(q) + 3) / 4;
      for (std::size_t t = first_[q]; t < first_[q + 1]; ++t) {
        for (const std::uint32_t v : triangles_[t]) nodes_[begin + (t - first_[q]) / 4].add(positions_[v]);
      }
      while (n > 1) {
        const std::size_t above = (n + 3) / 4;
        for (std::size_t i = 0; i < above; ++i) nodes_[begin + n + i] = join_four(nodes_, begin, n, i);
        begin += n;
        n = above;
      }
    }
  });
}

void PartTree::build_top_tree(const Task& task) {
  struct Key {
    std::uint64_t code;
    std::uint32_t part;
  };
  const std::size_t parts = first_.size() - 1;
  const auto box_of = [&](std::uint32_t q) {
    return node_first_[q + 1] > node_first_[q] ? nodes_[node_first_[q + 1] - 1] : Box3d{};
  };
  Box3d bounds;
  for (std::uint32_t q = 0; q < parts; ++q) {
    if (!box_of(q).empty()) bounds.add(box_of(q));
  }
  const Curve curve(bounds);
  std::vector<Key> keys(parts);
  for (std::uint32_t q = 0; q < parts; ++q) keys[q] = {box_of(q).empty() ? 0 : curve.key(box_of(q).center()), q};
  parallel_sort(keys, task, [](const Key& a, const Key& b) { return a.code < b.code; });
  place_of_.resize(parts);
  for (const Key& key : keys) {
    place_of_[key.part] = static_cast<std::uint32_t>(part_at_.size());
    part_at_.push_back(key.part);
    top_.push_back(box_of(key.part));
  }
  std::size_t begin = 0, n = parts;
  top_first_ = {0, static_cast<std::uint32_t>(n)};
  do {
    const std::size_t above = (n + 3) / 4;
    for (std::size_t i = 0; i < above; ++i) top_.push_back(join_four(top_, begin, n, i));
    begin += n;
    n = above;
    top_first_.push_back(static_cast<std::uint32_t>(top_.size()));
  } while (n > 1);
}

void PartTree::test_triangles(Vec3d p, const Visit& visit, NearestPart& best) const {
  const std::size_t begin = first_[visit.part] + std::size_t{visit.index} * 4;
  for (std::size_t t = begin; t < std::min<std::size_t>(begin + 4, first_[visit.part + 1]); ++t) {
    const auto [a, b, c] = triangles_[t];
    const double d = closest_point(p, positions_[a], positions_[b], positions_[c]).distance_sq;
    if (d > best.distance_sq) continue;
    const NearestPart found{visit.part, a, d};
    if (d < best.distance_sq || std::tie(found.part, found.vertex) < std::tie(best.part, best.vertex)) best = found;
  }
}

void PartTree::remove(std::uint32_t part) {
  std::size_t index = place_of_[part];
  top_[index] = Box3d{};
  for (std::size_t level = 0; level + 2 < top_first_.size(); ++level) {
    const std::size_t begin = top_first_[level], count = top_first_[level + 1] - begin;
    index /= 4;
    top_[top_first_[level + 1] + index] = join_four(top_, begin, count, index);
  }
}

}  // namespace lodestone::spatial
