#include "lodestone/math/triangle.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "lodestone/base/random.h"
#include "lodestone/math/box.h"
#include "lodestone/math/mat.h"

namespace lodestone {
namespace {

// Brute force over a fine barycentric grid: never nearer than the true distance, and close to it.
double brute_distance_sq(Vec3d p, Vec3d a, Vec3d b, Vec3d c) {
  constexpr int kSteps = 60;
  double best = 1e300;
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; i + j <= kSteps; ++j) {
      const double u = double(i) / kSteps, v = double(j) / kSteps;
      best = std::min(best, length_sq(p - (a * (1 - u - v) + b * u + c * v)));
    }
  }
  return best;
}

TEST(Triangle, closest_point_against_brute_force) {
  std::uint64_t k = 0;
  const auto next = [&] { return random_unit(5, k++) * 2 - 1; };
  for (int i = 0; i < 300; ++i) {
    const Vec3d a{next(), next(), next()}, b{next(), next(), next()}, c{next(), next(), next()},
        p{next(), next(), next()};
    const ClosestPoint found = closest_point(p, a, b, c);
    EXPECT_NEAR(length_sq(p - found.point), found.distance_sq, 1e-12);
    const double brute = brute_distance_sq(p, a, b, c);
    EXPECT_LE(found.distance_sq, brute + 1e-12);
    EXPECT_NEAR(std::sqrt(found.distance_sq), std::sqrt(brute), 0.04);
  }
}

TEST(Triangle, degenerate_ones_are_their_sides) {
  const Vec3d a{0, 0, 0}, b{1, 0, 0}, p{0.25, 3, 4};
  EXPECT_DOUBLE_EQ(closest_point(p, a, b, b).distance_sq, 25);
  EXPECT_DOUBLE_EQ(closest_point(p, a, a, b).distance_sq, 25);
  EXPECT_DOUBLE_EQ(closest_point(p, a, b, {0.5, 0, 0}).distance_sq, 25);
  EXPECT_DOUBLE_EQ(closest_point(p, b, b, b).distance_sq, 0.75 * 0.75 + 25);
}

// Points on a triangle are at distance 0 from it, however slender it is.
TEST(Triangle, needles_hold_their_own_points) {
  std::uint64_t k = 0;
  const auto next = [&] { return random_unit(7, k++); };
  for (const double width : {1.0, 1e-2, 1e-4, 1e-6}) {
    for (int i = 0; i < 300; ++i) {
      const Vec3d a{next(), next(), next()}, along{next() + 1, next(), next()},
          across = normalized(cross(along, Vec3d{next(), next(), next() + 1})) * width;
      const Vec3d b = a + along, c = a + along * next() + across;
      double s = next(), t = next();
      if (s + t > 1) s = 1 - s, t = 1 - t;
      const Vec3d on = a + (b - a) * s + (c - a) * t;
      const Vec3d corners[3] = {a, b, c};
      for (std::size_t turn = 0; turn < 3; ++turn) {
        const Vec3d &x = corners[turn], &y = corners[(turn + 1) % 3], &z = corners[(turn + 2) % 3];
        EXPECT_LT(std::sqrt(closest_point(on, x, y, z).distance_sq), 1e-8) << width;
        const Vec3d up = on + normalized(cross(b - a, c - a)) * 0.125;
        EXPECT_NEAR(std::sqrt(closest_point(up, x, y, z).distance_sq), 0.125, 1e-8) << width;
      }
    }
  }
}

TEST(Box, distance_and_growth) {
  Box3d box;
  EXPECT_TRUE(box.empty());
  EXPECT_EQ(box.diagonal(), 0);
  box.add(Vec3d{0, 0, 0});
  box.add(Vec3d{1, 2, 2});
  EXPECT_DOUBLE_EQ(box.diagonal(), 3);
  EXPECT_DOUBLE_EQ(box.distance_sq({0.5, 1, 1}), 0);
  EXPECT_DOUBLE_EQ(box.distance_sq({2, 2, 4}), 5);
}

TEST(Mat, products_act_right_to_left) {
  const Mat4d move = Mat4d::translation({1, 2, 3}), grow = Mat4d::scale({2, 2, 2});
  EXPECT_EQ((move * grow).point({1, 1, 1}), (Vec3d{3, 4, 5}));
  EXPECT_EQ((grow * move).point({1, 1, 1}), (Vec3d{4, 6, 8}));
  const double h = std::sqrt(0.5);
  const Vec3d turned = Mat4d::rotation(0, 0, h, h).point({1, 0, 0});
  EXPECT_NEAR(turned.x, 0, 1e-15);
  EXPECT_NEAR(turned.y, 1, 1e-15);
  EXPECT_DOUBLE_EQ(grow.scale_bound(), 2);
  EXPECT_LT(Mat4d::scale({-1, 1, 1}).determinant3(), 0);
}

TEST(Triangle, barycentric_weights_give_the_point_back) {
  std::uint64_t k = 0;
  const auto next = [&] { return random_unit(9, k++) * 2 - 1; };
  for (int i = 0; i < 300; ++i) {
    const Vec3d a{next(), next(), next()}, b{next(), next(), next()};
    // Every third has no area: on a line, or a point.
    const Vec3d c = i % 3 > 0 ? Vec3d{next(), next(), next()} : i % 2 > 0 ? lerp(a, b, 0.3) : a;
    const double u = random_unit(10, k), v = random_unit(11, k) * (1 - u);
    const Vec3d p = a * (1 - u - v) + b * u + c * v;
    const std::array<double, 3> w = barycentric(p, a, b, c);
    EXPECT_NEAR(length(a * w[0] + b * w[1] + c * w[2] - p), 0, 1e-9);
    EXPECT_NEAR(w[0] + w[1] + w[2], 1, 1e-12);
    EXPECT_GE(std::min({w[0], w[1], w[2]}), 0);
  }
  const std::array<double, 3> point = barycentric({1, 2, 3}, {}, {}, {});
  EXPECT_EQ(point, (std::array<double, 3>{1, 0, 0}));
}

}  // namespace
}  // namespace lodestone
