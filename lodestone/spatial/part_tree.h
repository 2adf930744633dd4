// Nearest part: closest-point queries on a mesh whose parts vanish one after another.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "lodestone/base/task.h"
#include "lodestone/core/mesh.h"
#include "lodestone/math/box.h"
#include "lodestone/math/triangle.h"

namespace lodestone::spatial {

/// The nearest part, the first vertex of its nearest triangle, and how far that triangle is.
struct NearestPart {
  std::uint32_t part = kNone, vertex = kNone;
  double distance_sq = std::numeric_limits<double>::infinity();
};

/// A tree of parts, and a tree of triangles in each part. So a part that a query must not find costs one test however
/// large it is, and one that vanishes is taken out in O(log n). All trees are packed: four children a node along a
/// Hilbert curve, no pointers. Build O(n log n), memory about 80 bytes a triangle.
class PartTree {
 public:
  /// `triangles` name positions; the part of each is that of its first vertex. `positions` must outlive the tree.
  PartTree(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles,
           const std::vector<std::uint32_t>& part_of_vertex, std::size_t parts, const Task& task = {});

  /// The nearest part that accept(part) allows within a distance, kNone if there is none. Exact in double precision; of
  /// equally near ones the lowest part, then the lowest vertex. Any thread.
  template <class Accept>
  NearestPart nearest(Vec3d p, const Accept& accept, double within_sq = std::numeric_limits<double>::infinity()) const;

  /// Takes a part out for good.
  void remove(std::uint32_t part);

 private:
  // What to visit: a node of the tree of parts (part = kNone) or of a part's own tree. Level 0 is the things
  // themselves, parts or triangles.
  struct Visit {
    double distance_sq;
    std::uint32_t part, level, index;
  };
  // A stack with the nearest of the last pushed on top: at most three wait on each of both trees' levels.
  struct Stack {
    std::array<Visit, 128> visits;
    std::size_t size = 0, group = 0;
    void push(const Visit& visit) {
      std::size_t place = size++;
      while (place > group && visits[place - 1].distance_sq < visit.distance_sq) {
        visits[place] = visits[place - 1];
        --place;
      }
      visits[place] = visit;
    }
  };
  void order_triangles(const std::vector<std::uint32_t>& part_of_vertex, std::size_t parts, const Task& task);
  void build_part_trees(const Task& task);
  void build_top_tree(const Task& task);
  void test_triangles(Vec3d p, const Visit& visit, NearestPart& best) const;
  std::size_t count_of(std::uint32_t part) const { return first_[part + 1] - first_[part]; }

  const std::vector<Vec3d>& positions_;
  std::vector<Triangle> triangles_;        // by part, within one along a Hilbert curve
  std::vector<std::uint32_t> first_;       // first triangle of each part, and the end
  std::vector<std::uint32_t> node_first_;  // first node of each part's own tree, and the end
  std::vector<Box3d> nodes_;               // of all parts: level 1 (over triangles) first, the part's root last
  std::vector<std::uint32_t> part_at_;     // parts along a Hilbert curve
  std::vector<std::uint32_t> place_of_;    // and where each stands
  std::vector<Box3d> top_;                 // the tree of parts: level 0 (a box a part) first, the root last
  std::vector<std::uint32_t> top_first_;   // first node of each of its levels, and the end
};

template <class Accept>
NearestPart PartTree::nearest(Vec3d p, const Accept& accept, double within_sq) const {
  NearestPart best;
  best.distance_sq = within_sq;
  Stack stack;
  stack.push({0, kNone, static_cast<std::uint32_t>(top_first_.size() - 2), 0});
  while (stack.size > 0) {
    const Visit visit = stack.visits[--stack.size];
    if (visit.distance_sq > best.distance_sq) continue;
    stack.group = stack.size;
    if (visit.part != kNone && visit.level == 1) {
      test_triangles(p, visit, best);
    } else if (visit.part == kNone && visit.level == 0) {
      const std::uint32_t part = part_at_[visit.index];
      if (!accept(part)) continue;
      std::uint32_t level = 1;
      for (std::size_t n = (count_of(part) + 3) / 4; n > 1; n = (n + 3) / 4) ++level;
      stack.push({visit.distance_sq, part, level, 0});
    } else {
      // Children of a node, in the tree of parts or in a part's own.
      std::size_t begin = 0, count = 0;
      if (visit.part == kNone) {
        begin = top_first_[visit.level - 1];
        count = top_first_[visit.level] - begin;
      } else {
        begin = node_first_[visit.part];
        count = (count_of(visit.part) + 3) / 4;
        for (std::uint32_t level = 1; level + 1 < visit.level; ++level) {
          begin += count;
          count = (count + 3) / 4;
        }
      }
      const std::vector<Box3d>& boxes = visit.part == kNone ? top_ : nodes_;
      for (std::uint32_t i = visit.index * 4; i < visit.index * 4 + 4 && i < count; ++i) {
        const double d = boxes[begin + i].distance_sq(p);
        if (d <= best.distance_sq && d < std::numeric_limits<double>::infinity()) {
          stack.push({d, visit.part, visit.level - 1, i});
        }
      }
    }
  }
  return best;
}

}  // namespace lodestone::spatial
