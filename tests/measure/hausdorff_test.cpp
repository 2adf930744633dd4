#include "lodestone/measure/hausdorff.h"

#include <gtest/gtest.h>

#include "lodestone/measure/distance.h"
#include "support/shapes.h"

namespace lodestone::measure {
namespace {

TEST(Hausdorff, squares_of_known_distance) {
  Mesh half = test::grid(4);
  for (Vec3f& p : half.positions) p.x *= 0.5F;
  const auto h = hausdorff(make_model(test::grid(5)), make_model(half), 1e-4);
  ASSERT_TRUE(h);
  EXPECT_LE(h->forward.lower, 0.5 + 1e-12);
  EXPECT_GE(h->forward.upper, 0.5 - 1e-12);
  EXPECT_LE(h->forward.upper - h->forward.lower, 1e-4);
  EXPECT_LE(h->backward.upper, 1e-4);
  EXPECT_EQ(h->upper, h->forward.upper);
}

// Samples never find more than the bound, nor a bound much more than samples, whatever the triangles.
TEST(Hausdorff, holds_what_samples_find) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    const Model a = make_model(test::soup(seed, 12, 5)), b = make_model(test::soup(seed + 99, 12, 4));
    const double tolerance = 1e-3;
    const auto h = hausdorff(a, b, tolerance);
    const auto dense = distance(a, b, {50'000, seed, false});
    ASSERT_TRUE(h && dense);
    for (const auto& [interval, sampled] : {std::pair{h->forward, dense->forward}, {h->backward, dense->backward}}) {
      EXPECT_GE(interval.upper, sampled.sampled_max) << seed;
      EXPECT_LE(interval.upper - interval.lower, tolerance) << seed;
      EXPECT_LE(interval.lower, interval.upper) << seed;
    }
  }
}

TEST(Hausdorff, coincident_points_and_distant_meshes) {
  const Model torus = make_model(test::torus(20));
  EXPECT_LE(hausdorff(torus, torus, 1e-6)->upper, 1e-6);
  const Model point = make_model(test::make_mesh({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, {{0, 1, 2}}));
  const auto far = hausdorff(point, torus, 1e-3);
  ASSERT_TRUE(far);
  EXPECT_LE(far->upper - far->lower, 1e-3);
  EXPECT_GT(far->backward.lower, 1);
  Mesh moved = test::torus(20);
  moved.offset = {1e6, 0, 0};
  const auto apart = hausdorff(make_model(moved), torus, 10);
  ASSERT_TRUE(apart);
  EXPECT_NEAR(apart->lower, 1e6, 10);
}

TEST(Hausdorff, same_interval_for_any_thread_count) {
  const Model a = make_model(test::torus(40)), b = make_model(test::torus(13));
  const auto one = hausdorff(a, b, 1e-3, Task::root({}, 1)), seven = hausdorff(a, b, 1e-3, Task::root({}, 7));
  EXPECT_EQ(one->lower, seven->lower);
  EXPECT_EQ(one->upper, seven->upper);
}

TEST(Hausdorff, bad_tolerance) {
  const Model a = make_model(test::torus(5));
  EXPECT_EQ(hausdorff(a, a, 0).error().code, ErrorCode::bad_argument);
  EXPECT_EQ(hausdorff(a, a, -1).error().code, ErrorCode::bad_argument);
}

}  // namespace
}  // namespace lodestone::measure
