#include "lodestone/measure/distance.h"

#include <gtest/gtest.h>

#include <limits>

#include "lodestone/measure/screen.h"
#include "support/shapes.h"

namespace lodestone::measure {
namespace {

Distance measured(const Mesh& a, const Mesh& b, std::uint64_t samples = 50'000, int threads = 0) {
  const auto d = distance(make_model(a), make_model(b), {samples, 1, true}, Task::root({}, threads));
  EXPECT_TRUE(d);
  return d ? *d : Distance{};
}

TEST(Distance, a_mesh_to_itself_is_zero) {
  for (const test::Shape& shape : test::small_shapes()) {
    const Distance d = measured(shape.make(), shape.make(), 2000);
    EXPECT_LE(d.max, 1e-7 * d.diagonal) << shape.name;
  }
}

TEST(Distance, parallel_squares) {
  Mesh above = test::grid(4);
  for (Vec3f& p : above.positions) p.z = 0.25F;
  const Distance d = measured(test::grid(7), above);
  EXPECT_NEAR(d.max, 0.25, 1e-12);
  EXPECT_NEAR(d.mean, 0.25, 1e-12);
  EXPECT_NEAR(d.rms, 0.25, 1e-12);
  EXPECT_NEAR(d.normal_degrees, 0, 1e-6);
  EXPECT_NEAR(d.diagonal, std::sqrt(2.0), 1e-12);
}

// A simplified mesh whose vertices lie on the original reads 0 by its vertices alone: samples must see what is between.
TEST(Distance, vertices_on_the_original_do_not_make_the_error_zero) {
  const Mesh fine = test::sphere(32);
  Mesh coarse = test::sphere(4);
  const Distance d = measured(fine, coarse);
  EXPECT_GT(d.backward.mean, 0.01);
  EXPECT_GT(d.backward.max, 0.05);
  EXPECT_GT(d.forward.max, 0.05);
}

// Half a unit square against the whole: the far corner is 0.5 away, which only one direction sees.
TEST(Distance, both_directions_count) {
  Mesh half = test::grid(4);
  for (Vec3f& p : half.positions) p.x *= 0.5F;
  const Distance d = measured(test::grid(4), half);
  EXPECT_NEAR(d.forward.max, 0.5, 1e-9);
  EXPECT_NEAR(d.backward.max, 0, 1e-7);
  EXPECT_NEAR(d.max, 0.5, 1e-9);
  EXPECT_NEAR(d.forward.mean, 0.125, 1e-3);
  EXPECT_NEAR(d.mean, 0.0625, 1e-3);
}

// The peak of a roof that is cut off: few samples miss it, bounding finds it.
TEST(Distance, bounding_finds_the_maximum_inside_a_large_face) {
  const Mesh flat = test::make_mesh({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}});
  const Mesh roof = test::make_mesh({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.37F, 0.61F, 0.2F}},
                                    {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}});
  const auto rough = distance(make_model(flat), make_model(roof), {20, 1, false});
  const auto sharp = distance(make_model(flat), make_model(roof), {20, 1, true});
  const auto reference = distance(make_model(flat), make_model(roof), {2'000'000, 1, true});
  EXPECT_LT(rough->forward.max, sharp->forward.max);
  EXPECT_NEAR(sharp->forward.max, reference->forward.max, 0.01 * reference->forward.max);
  EXPECT_FALSE(rough->is_bounded);
  EXPECT_TRUE(sharp->is_bounded);
}

// Whatever the triangles: no point of one surface is farther from the other than the bound, and some point is nearly as
// far.
TEST(Distance, bounds_hold_for_any_triangles) {
  for (unsigned seed = 1; seed <= 60; ++seed) {
    const Mesh a = test::soup(seed, 9, static_cast<int>(1 + seed % 7)),
               b = test::soup(seed + 1000, 9, static_cast<int>(1 + seed % 5));
    const auto d = distance(make_model(a), make_model(b), {50, seed, true, 0.01, 0, 100'000});
    const auto dense = distance(make_model(a), make_model(b), {100'000, seed, false});
    ASSERT_TRUE(d && dense);
    EXPECT_TRUE(d->is_bounded) << seed;
    EXPECT_LE(d->bound, 1.01 * d->max) << seed;
    EXPECT_GE(d->forward.bound, dense->forward.max) << seed;
    EXPECT_GE(d->backward.bound, dense->backward.max) << seed;
    EXPECT_GE(d->trusted_max(), dense->max) << seed;
  }
}

// Simplified meshes: triangles of one span edges and corners of the other, where bounds are hardest to get.
TEST(Distance, bounds_hold_for_a_coarser_mesh) {
  for (const int n : {3, 5, 8, 13}) {
    const auto d =
        distance(make_model(test::torus(40)), make_model(test::torus(n)), {1000, 1, true, 0.01, 0, 1'000'000});
    const auto dense = distance(make_model(test::torus(40)), make_model(test::torus(n)), {200'000, 1, false});
    ASSERT_TRUE(d && dense);
    EXPECT_TRUE(d->is_bounded) << n;
    EXPECT_GE(d->bound, dense->max) << n;
    EXPECT_LE(d->bound, 1.01 * d->max) << n;
  }
}

// Too few queries: the bound is far above, still true, and not called reached.
TEST(Distance, a_bound_that_was_given_up_still_holds) {
  const auto d = distance(make_model(test::torus(60)), make_model(test::torus(50)), {1000, 1, true, 0.001, 0, 10});
  const auto dense = distance(make_model(test::torus(60)), make_model(test::torus(50)), {1'000'000, 1, false});
  EXPECT_FALSE(d->is_bounded);
  EXPECT_GE(d->bound, dense->max);
  EXPECT_EQ(d->trusted_max(), d->max);
}

// A square beside one that rises from 0 to 1: the distances are spread evenly.
TEST(Distance, percentiles_and_histogram) {
  Mesh slope = test::grid(1);
  for (Vec3f& p : slope.positions) p = {p.x * 1e-3F, p.y, p.y};
  Mesh wall = test::grid(1);
  for (Vec3f& p : wall.positions) p = {p.x * 1e-3F, p.y, 0};
  const DirectedDistance d = measured(wall, slope).forward;
  // From the wall at height y to a plane at 45 degrees: y / sqrt(2).
  EXPECT_NEAR(d.median, 0.5 / std::sqrt(2.0), 2e-3);
  EXPECT_NEAR(d.percentile_95, 0.95 / std::sqrt(2.0), 2e-3);
  EXPECT_NEAR(d.percentile_99, 0.99 / std::sqrt(2.0), 2e-3);
  std::uint64_t all = 0;
  for (const std::uint64_t n : d.histogram) {
    EXPECT_NEAR(static_cast<double>(n), 50'000.0 / 64, 100);
    all += n;
  }
  EXPECT_EQ(all, 50'000U);
  EXPECT_NEAR(d.histogram_step * 64, d.sampled_max, 1e-3);
}

TEST(Distance, same_figures_for_any_thread_count) {
  const Mesh a = test::torus(40), b = test::torus(13);
  const Distance one = measured(a, b, 30'000, 1), two = measured(a, b, 30'000, 2), seven = measured(a, b, 30'000, 7);
  for (const Distance* d : {&two, &seven}) {
    EXPECT_EQ(one.max, d->max);
    EXPECT_EQ(one.bound, d->bound);
    EXPECT_EQ(one.mean, d->mean);
    EXPECT_EQ(one.rms, d->rms);
    EXPECT_EQ(one.normal_degrees, d->normal_degrees);
  }
}

TEST(Distance, far_from_the_origin_gives_the_same) {
  Mesh a = test::torus(30), b = test::torus(9);
  const Distance near = measured(a, b, 20'000);
  a.offset = b.offset = {1e6, -1e6, 1e6};
  const Distance far = measured(a, b, 20'000);
  EXPECT_NEAR(far.mean, near.mean, 1e-8);
  EXPECT_NEAR(far.max, near.max, 1e-6);
}

TEST(Distance, degenerate_and_distant_meshes) {
  const Mesh point = test::make_mesh({{0, 0, 0}}, {{0, 0, 0}});
  Mesh moved = test::cube();
  for (Vec3f& p : moved.positions) p.x += 1e6F;
  EXPECT_NEAR(measured(point, test::cube(), 100).max, std::sqrt(3.0), 1e-9);
  EXPECT_NEAR(measured(test::cube(), moved, 100).max, 1e6, 1);
  EXPECT_FALSE(distance(make_model(test::cube()), Model{}));
}

TEST(Distance, a_cancelled_measurement_is_an_error) {
  const Task task = Task::root({});
  task.cancel();
  const auto d = distance(make_model(test::cube()), make_model(test::cube()), {}, task);
  ASSERT_FALSE(d);
  EXPECT_EQ(d.error().code, ErrorCode::cancelled);
}

TEST(Screen, pixels_and_errors_are_inverse) {
  const View view{1080, 45, 16.0 / 9};
  EXPECT_NEAR(error_to_pixels(pixels_to_error(1, 12.5, view), 12.5, view), 1, 1e-12);
  EXPECT_NEAR(error_to_pixels(0.01, switch_distance(0.01, 1, view), view), 1, 1e-12);
  // A metre seen from a metre at 90 degrees covers half the lines.
  EXPECT_NEAR(error_to_pixels(1, 1, {1000, 90, 1}), 500, 1e-9);
  EXPECT_LE(screen_coverage(1, 0, view), 1);
  EXPECT_GT(screen_coverage(1, 1, view), screen_coverage(1, 2, view));
}

TEST(Screen, orthographic_views_know_no_distance) {
  View view;
  view.orthographic_height = 10;
  view.height_px = 1000;
  EXPECT_NEAR(error_to_pixels(0.02, 3, view), 2, 1e-12);
  EXPECT_EQ(error_to_pixels(0.02, 3, view), error_to_pixels(0.02, 300, view));
  EXPECT_NEAR(pixels_to_error(2, 7, view), 0.02, 1e-12);
  EXPECT_EQ(switch_distance(0.005, 1, view), 0);
  EXPECT_EQ(switch_distance(0.02, 1, view), std::numeric_limits<double>::infinity());
  EXPECT_NEAR(screen_coverage(1, 50, view), 3.14159265 / (100 * 16.0 / 9), 1e-9);
}

}  // namespace
}  // namespace lodestone::measure
