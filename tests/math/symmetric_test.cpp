#include "lodestone/math/symmetric.h"

#include <gtest/gtest.h>

#include "lodestone/base/random.h"

namespace lodestone {
namespace {

TEST(Symmetric, axes_are_orthogonal_eigenvectors) {
  for (std::uint64_t i = 0; i < 200; ++i) {
    Symmetric3d m;
    const std::uint64_t ranks = 1 + i % 4;
    for (std::uint64_t k = 0; k < ranks; ++k) {
      const auto random = [&](std::uint64_t c) { return random_unit(3, 16 * i + 4 * k + c) - 0.5; };
      m.add({random(0), random(1), random(2)}, random(3));
    }
    const auto axes = axes_of(m);
    for (std::size_t a = 0; a < 3; ++a) {
      const Vec3d image{dot(m.rows[0], axes[a]), dot(m.rows[1], axes[a]), dot(m.rows[2], axes[a])};
      EXPECT_LT(length(image - axes[a] * m.form(axes[a])), 1e-14);
      EXPECT_NEAR(length(axes[a]), 1, 1e-14);
      EXPECT_NEAR(dot(axes[a], axes[(a + 1) % 3]), 0, 1e-14);
    }
  }
  EXPECT_EQ(axes_of({})[2], (Vec3d{0, 0, 1}));
}

}  // namespace
}  // namespace lodestone
