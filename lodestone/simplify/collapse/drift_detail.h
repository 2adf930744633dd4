// How far a point has drifted from the original surface, by what the triangles of a fan know.
#pragma once

#include <cstddef>
#include <vector>

#include "lodestone/math/vec.h"

namespace lodestone::simplify::detail {

/// A triangle of a fan, seen from the apex.
struct alignas(16) Leaf {
  Vec3f a;  ///< relative to the apex
  float drift_a;
  Vec3f b;
  float drift_b;
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
  /// Distance from q (relative to the apex) to the nearest triangle that it is above or below, and the drift there,
  /// interpolated. False = there is none.
  bool drift_above(Vec3f q, float apex_drift, float& drift) const;
  /// The same to the nearest edge. At least one triangle.
  float drift_at_edges(Vec3f q, float apex_drift) const;
  /// The one or the other.
  float drift_at(Vec3f q, float apex_drift) const;

 private:
  std::vector<Leaf> leaf_;
  std::size_t size_ = 0;
  float rounding_;
};

}  // namespace lodestone::simplify::detail
