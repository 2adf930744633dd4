#include "lodestone/spatial/snap.h"

#include <gtest/gtest.h>

#include "lodestone/base/random.h"

namespace lodestone::spatial {
namespace {

TEST(Snap, near_points_become_one_and_nothing_moves_farther_than_the_tolerance) {
  std::vector<Vec3f> points;
  for (std::uint64_t i = 0; i < 3000; ++i) {
    points.push_back({static_cast<float>(random_unit(1, 3 * i)), static_cast<float>(random_unit(1, 3 * i + 1)),
                      static_cast<float>(random_unit(1, 3 * i + 2))});
  }
  for (const double tolerance : {1e-3, 0.03, 0.2, 5.0}) {
    std::vector<Vec3f> snapped = points;
    const auto moved = snap_positions(snapped, tolerance);
    ASSERT_TRUE(moved);
    std::vector<Vec3f> kept;
    for (std::size_t v = 0; v < points.size(); ++v) {
      EXPECT_LE(length(to_double(snapped[v]) - to_double(points[v])), tolerance);
      if (snapped[v] != points[v]) continue;
      for (const Vec3f& k : kept) EXPECT_GT(length(to_double(k) - to_double(points[v])), tolerance);
      kept.push_back(points[v]);
    }
    EXPECT_EQ(kept.size() + *moved, points.size());
  }
}

TEST(Snap, a_chain_of_near_points_does_not_creep) {
  std::vector<Vec3f> points;
  for (int i = 0; i < 10; ++i) points.push_back({static_cast<float>(i) * 0.75F, 0, 0});
  ASSERT_TRUE(snap_positions(points, 1));
  for (int i = 0; i < 10; ++i) EXPECT_EQ(points[static_cast<std::size_t>(i)].x, static_cast<float>(i - i % 2) * 0.75F);
}

TEST(Snap, fixed_points_keep_their_places_and_the_others_come) {
  std::vector<Vec3f> points{{0, 0, 0}, {0.5F, 0, 0}, {0.9F, 0, 0}, {5, 0, 0}};
  const std::vector<Vec3f> before = points;
  ASSERT_TRUE(snap_positions(points, 1, {0, 1, 1, 0}));
  EXPECT_EQ(points, (std::vector<Vec3f>{before[1], before[1], before[2], before[3]}));
}

TEST(Snap, far_and_tiny_is_no_trouble) {
  std::vector<Vec3f> points{{3e38F, 0, 0}, {3e38F, 0, 0}, {1e-40F, 0, 0}, {0, 0, 0}};
  ASSERT_TRUE(snap_positions(points, 1e-30));
  EXPECT_EQ(points[3], points[2]);
  EXPECT_EQ(snap_positions(points, 0).error().code, ErrorCode::bad_argument);
}

}  // namespace
}  // namespace lodestone::spatial
