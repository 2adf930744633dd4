// How far a point has come from the original surface, by what the triangles of a fan know.
#pragma once

#include <cstddef>
#include <vector>

#include "lodestone/math/vec.h"

namespace lodestone::simplify::detail {

/// A triangle of a fan, seen from the apex.
struct alignas(16) Leaf {
  Vec3f a;  ///< relative to the apex
  float error_a;
  Vec3f b;
  float error_b;
  Vec3f n;               ///< cross(a, b)
  float inverse_square;  ///< of the length of n; 0 for a triangle without area
};

class FanDistance {
 public:
  /// Distances below `rounding` count as 0: they would add up to something on flats of many triangles.
  explicit FanDistance(float rounding) : rounding_(rounding) {}
  void clear() { size_ = 0; }
  void add(const Leaf& leaf) {
    if (size_ == leaf_.size()) leaf_.resize(size_ + 64);
    leaf_[size_++] = leaf;
  }
  /// Call once all triangles are added.
  void pad();
  /// Distance from q (relative to the apex) to the nearest triangle that it is above or below, and the accumulated
  /// error there, interpolated. False = there is none.
  bool error_above(Vec3f q, float apex_error, float& accumulated) const;
  /// The same to the nearest edge. At least one triangle.
  float error_at_edges(Vec3f q, float apex_error) const;
  /// The one or the other.
  float error_at(Vec3f q, float apex_error) const;

 private:
  std::vector<Leaf> leaf_;
  std::size_t size_ = 0;
  float rounding_;
};

}  // namespace lodestone::simplify::detail
