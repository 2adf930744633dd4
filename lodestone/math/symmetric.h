// Symmetric 3x3 matrices and their axes.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "lodestone/math/vec.h"

namespace lodestone {

/// Rows of a symmetric matrix; both halves are kept.
struct Symmetric3d {
  std::array<Vec3d, 3> rows{};

  /// Adds weight * v v^T.
  constexpr void add(Vec3d v, double weight) {
    for (std::size_t i = 0; i < 3; ++i) rows[i] += v * (v[i] * weight);
  }
  /// v^T M v.
  constexpr double form(Vec3d v) const { return dot(v, Vec3d{dot(rows[0], v), dot(rows[1], v), dot(rows[2], v)}); }
};

/// Three orthogonal unit eigenvectors, in no particular order: Jacobi's rotations, sqrt alone.
inline std::array<Vec3d, 3> axes_of(Symmetric3d m) {
  std::array<Vec3d, 3> axes{Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}};
  for (int sweep = 0; sweep < 12; ++sweep) {
    for (const auto& [p, q] : {std::pair<std::size_t, std::size_t>{0, 1}, {0, 2}, {1, 2}}) {
      const double off = m.rows[p][q];
      if (off == 0) continue;
      const double half = (m.rows[q][q] - m.rows[p][p]) / (2 * off);
      const double t = (half < 0 ? -1 : 1) / (std::abs(half) + std::sqrt(half * half + 1));
      const double c = 1 / std::sqrt(t * t + 1), s = t * c;
      for (std::size_t k = 0; k < 3; ++k) {
        const double a = m.rows[k][p], b = m.rows[k][q];
        m.rows[k][p] = c * a - s * b;
        m.rows[k][q] = s * a + c * b;
      }
      const Vec3d a = m.rows[p], b = m.rows[q];
      m.rows[p] = a * c - b * s;
      m.rows[q] = a * s + b * c;
      m.rows[p][q] = m.rows[q][p] = 0;
      const Vec3d x = axes[p], y = axes[q];
      axes[p] = x * c - y * s;
      axes[q] = x * s + y * c;
    }
  }
  return axes;
}

}  // namespace lodestone
