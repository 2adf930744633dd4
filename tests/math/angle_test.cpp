#include "lodestone/math/angle.h"

#include <gtest/gtest.h>

namespace lodestone {
namespace {

TEST(Angle, arc_cosine_inverts_the_cosine) {
  for (int i = 0; i <= 1800; ++i) {
    const double degrees = i * 0.1;
    EXPECT_NEAR(arc_cosine_degrees(sin_cos_degrees(degrees).cos), degrees, 2e-6) << degrees;
  }
}

TEST(Angle, arc_cosine_at_its_ends_and_beyond) {
  EXPECT_EQ(arc_cosine_degrees(1), 0);
  EXPECT_EQ(arc_cosine_degrees(-1), 180);
  EXPECT_EQ(arc_cosine_degrees(1 + 1e-12), 0);
  EXPECT_EQ(arc_cosine_degrees(-1 - 1e-12), 180);
}

TEST(Angle, arc_tangent_of_all_directions) {
  for (int i = -1799; i <= 1800; ++i) {
    const SinCos at = sin_cos_degrees(i * 0.1);
    EXPECT_NEAR(arc_tangent(at.sin * 3, at.cos * 3) * 180 / 3.14159265358979, i * 0.1, 3e-6) << i;
  }
  EXPECT_EQ(arc_tangent(0, 0), 0);
  EXPECT_EQ(arc_tangent(0, 5), 0);
}

}  // namespace
}  // namespace lodestone
