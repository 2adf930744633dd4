// 4x4 transforms, column-major as in glTF: m[column * 4 + row].
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "lodestone/math/vec.h"

namespace lodestone {

struct Mat4d {
  std::array<double, 16> m{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

  friend constexpr bool operator==(const Mat4d&, const Mat4d&) = default;

  friend constexpr Mat4d operator*(const Mat4d& a, const Mat4d& b) {
    Mat4d out;
    for (std::size_t column = 0; column < 4; ++column) {
      for (std::size_t row = 0; row < 4; ++row) {
        double sum = 0;
        for (std::size_t k = 0; k < 4; ++k) sum += a.m[k * 4 + row] * b.m[column * 4 + k];
        out.m[column * 4 + row] = sum;
      }
    }
    return out;
  }

  constexpr Vec3d point(Vec3d p) const {
    return {m[0] * p.x + m[4] * p.y + m[8] * p.z + m[12], m[1] * p.x + m[5] * p.y + m[9] * p.z + m[13],
            m[2] * p.x + m[6] * p.y + m[10] * p.z + m[14]};
  }
  constexpr Vec3d direction(Vec3d p) const {
    return {m[0] * p.x + m[4] * p.y + m[8] * p.z, m[1] * p.x + m[5] * p.y + m[9] * p.z,
            m[2] * p.x + m[6] * p.y + m[10] * p.z};
  }
  /// Of the upper left 3x3; negative for a mirror.
  constexpr double determinant3() const {
    return dot(Vec3d{m[0], m[1], m[2]}, cross(Vec3d{m[4], m[5], m[6]}, Vec3d{m[8], m[9], m[10]}));
  }
  constexpr bool is_identity() const { return *this == Mat4d{}; }

  /// How much a length may grow: an upper bound of the largest singular value of the upper left 3x3, exact for
  /// rotations with uniform scale (the Frobenius norm over the root of 3 would be too small for others, so columns are
  /// used).
  double scale_bound() const {
    const Vec3d x{m[0], m[1], m[2]}, y{m[4], m[5], m[6]}, z{m[8], m[9], m[10]};
    const double longest = std::max({length(x), length(y), length(z)});
    const double skew = std::abs(dot(x, y)) + std::abs(dot(x, z)) + std::abs(dot(y, z));
    return std::sqrt(longest * longest + (skew > 1e-12 * longest * longest ? 2 * skew : 0.0));
  }

  /// The inverse of the upper left 3x3, without translation; identity where that is singular.
  constexpr Mat4d inverse3() const {
    const Vec3d x{m[0], m[1], m[2]}, y{m[4], m[5], m[6]}, z{m[8], m[9], m[10]};
    const double d = determinant3();
    Mat4d out;
    if (!(d < 0 || d > 0)) return out;
    const Vec3d rows[3] = {cross(y, z) / d, cross(z, x) / d, cross(x, y) / d};
    for (std::size_t row = 0; row < 3; ++row) {
      for (std::size_t column = 0; column < 3; ++column) out.m[column * 4 + row] = rows[row][column];
    }
    return out;
  }
  /// Without translation and perspective.
  constexpr Mat4d linear() const {
    Mat4d out = *this;
    out.m[12] = out.m[13] = out.m[14] = out.m[3] = out.m[7] = out.m[11] = 0;
    out.m[15] = 1;
    return out;
  }

  static constexpr Mat4d translation(Vec3d t) {
    Mat4d out;
    out.m[12] = t.x;
    out.m[13] = t.y;
    out.m[14] = t.z;
    return out;
  }
  static constexpr Mat4d scale(Vec3d s) {
    Mat4d out;
    out.m[0] = s.x;
    out.m[5] = s.y;
    out.m[10] = s.z;
    return out;
  }
  /// From a unit quaternion (x, y, z, w).
  static constexpr Mat4d rotation(double x, double y, double z, double w) {
    Mat4d out;
    out.m = {1 - 2 * (y * y + z * z),
             2 * (x * y + z * w),
             2 * (x * z - y * w),
             0,
             2 * (x * y - z * w),
             1 - 2 * (x * x + z * z),
             2 * (y * z + x * w),
             0,
             2 * (x * z + y * w),
             2 * (y * z - x * w),
             1 - 2 * (x * x + y * y),
             0,
             0,
             0,
             0,
             1};
    return out;
  }
};

}  // namespace lodestone
