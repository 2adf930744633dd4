// Axis-aligned boxes.
#pragma once

#include <algorithm>
#include <limits>

#include "lodestone/math/vec.h"

namespace lodestone {

/// Empty until something is added (min > max).
template <class T>
struct Box3 {
  Vec3<T> min{std::numeric_limits<T>::infinity(), std::numeric_limits<T>::infinity(),
              std::numeric_limits<T>::infinity()};
  Vec3<T> max = -min;

  constexpr bool empty() const { return !(min.x <= max.x); }
  constexpr void add(Vec3<T> p) {
    min = {std::min(min.x, p.x), std::min(min.y, p.y), std::min(min.z, p.z)};
    max = {std::max(max.x, p.x), std::max(max.y, p.y), std::max(max.z, p.z)};
  }
  constexpr void add(const Box3& b) {
    min = {std::min(min.x, b.min.x), std::min(min.y, b.min.y), std::min(min.z, b.min.z)};
    max = {std::max(max.x, b.max.x), std::max(max.y, b.max.y), std::max(max.z, b.max.z)};
  }
  constexpr Vec3<T> center() const { return (min + max) * T(0.5); }
  constexpr Vec3<T> size() const { return empty() ? Vec3<T>{} : max - min; }
  T diagonal() const { return length(size()); }

  /// Squared distance from a point to the box, 0 inside.
  constexpr T distance_sq(Vec3<T> p) const {
    const T x = std::max({min.x - p.x, T(0), p.x - max.x});
    const T y = std::max({min.y - p.y, T(0), p.y - max.y});
    const T z = std::max({min.z - p.z, T(0), p.z - max.z});
    return x * x + y * y + z * z;
  }
};

using Box3f = Box3<float>;
using Box3d = Box3<double>;

}  // namespace lodestone
