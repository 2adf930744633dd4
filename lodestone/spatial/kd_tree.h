// Nearest points: a balanced tree over points that are sorted by its leaves.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "lodestone/base/parallel.h"
#include "lodestone/base/task.h"
#include "lodestone/math/box.h"
#include "lodestone/math/vec.h"

namespace lodestone::spatial {

struct Neighbor {
  std::uint32_t point = 0;  ///< index into the points that the tree was made from
  double distance_sq = 0;   ///< model units squared, right to about seven digits
};

/// Cells of at most sixteen points each, halved along their longest side, so that no arrangement (duplicates, clusters
/// far apart) makes them large or deep; neighbouring cells lie near each other in memory. Points must be finite, below
/// 2^32 - 1 of them; the tree keeps its own copy. Which of several equally far points is taken is fixed, but not by
/// their numbers. Build O(n log n), a query about O(k + log n), memory 22 bytes a point. The same answers for any
/// thread count.
class KdTree {
 public:
  explicit KdTree(std::span<const Vec3f> points, const Task& task = {});

  std::size_t size() const { return order_.size(); }
  /// The points as they lie in the tree: near in this list is near in space.
  std::span<const std::uint32_t> order() const { return order_; }

  /// Where order()[slot] lies.
  Vec3d position(std::size_t slot) const {
    return Vec3d{double(at_[0][slot]), double(at_[1][slot]), double(at_[2][slot])} * unit_;
  }

  /// The points nearest to `at`, nearest first, at most into.size() of them, all nearer than the root of `below_sq`
  /// (model units squared). Returns how many there are. `at` counts as at most 1e18 times as far as any point lies.
  std::size_t nearest(Vec3d at, std::span<Neighbor> into,
                      double below_sq = std::numeric_limits<double>::infinity()) const;

  /// Calls take(point, neighbors) for every point, with its k nearest others (all of them where there are fewer),
  /// nearest first. In parallel: calls for different points may come at the same time; points come in the tree's order
  /// within each chunk. Faster than nearest() for each. Claims the whole task.
  template <class Take>
  void each_neighborhood(std::size_t k, const Task& task, Take&& take) const {
    parallel_for(order_.size(), kChunk, task, [&](std::size_t begin, std::size_t end, std::size_t) {
      std::vector<Found> found(k + 1);
      std::vector<Neighbor> neighbors(k);
      Hint hint;
      for (std::size_t slot = begin; slot < end; ++slot) {
        const std::size_t count = around(slot, found, hint);
        for (std::size_t i = 0; i < count; ++i) neighbors[i] = neighbor(found[i]);
        take(order_[slot], std::span<const Neighbor>(neighbors.data(), count));
      }
      task.advance(static_cast<double>(end - begin) / static_cast<double>(order_.size()));
    });
  }

 private:
  static constexpr std::size_t kLeaf = 16;
  static constexpr std::size_t kChunk = 2048;
  struct Found {
    float distance_sq = 0;  // in the tree's units
    std::uint32_t slot = 0;
  };
  // The query before: its neighbours bound how far those of one beside it can be.
  struct Hint {
    bool there = false;
    std::size_t slot = 0;
    float reach_sq = 0;
  };
  struct Builder;

  std::size_t first_of(std::size_t node, unsigned level) const {
    return static_cast<std::size_t>(std::uint64_t{order_.size()} * node >> level);
  }
  Neighbor neighbor(const Found& f) const {
    return {order_[f.slot], static_cast<double>(f.distance_sq) * unit_ * unit_};
  }
  std::size_t search(std::array<float, 3> at, std::span<Found> found, float below_sq) const;
  std::size_t scan_leaf(std::size_t leaf, std::array<float, 3> at, std::span<Found> found, std::size_t count,
                        float& worst) const;
  // The nearest others of the point in a slot; `found` has room for one more.
  std::size_t around(std::size_t slot, std::span<Found> found, Hint& hint) const;
  float box_distance_sq(std::size_t node, std::array<float, 3> at) const;

  double unit_ = 1;      // of the tree in model units, a power of two: coordinates are then about 1, and squares safe
  unsigned levels_ = 0;  // below the root; 2^levels leaves
  std::vector<std::uint32_t> order_;
  std::array<std::vector<float>, 3> at_;  // coordinates by slot, with some more so that a leaf can be read whole
  std::vector<Box3f> boxes_;              // node i has children 2 i and 2 i + 1; the root is 1
};

/// How far points lie apart, by the distance to the sixth nearest other one, model units: on an evenly sampled surface
/// about 1.4 times the distance between neighbours.
struct Spacing {
  double median = 0;
  double wide = 0;  ///< that 98 % of the points don't exceed
};

/// From all points, or some 50,000 spread evenly over them. 0 for fewer than two points.
Spacing point_spacing(const KdTree& tree, const Task& task = {});

}  // namespace lodestone::spatial
