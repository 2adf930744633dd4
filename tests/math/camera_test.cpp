#include "lodestone/math/camera.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "lodestone/math/angle.h"

namespace lodestone {
namespace {

TEST(Angle, IsWhatTheLibrarySays) {
  for (double degrees = -800; degrees < 800; degrees += 7.3) {
    const SinCos found = sin_cos_degrees(degrees);
    EXPECT_NEAR(found.sin, std::sin(degrees * 3.14159265358979323846 / 180), 1e-14) << degrees;
    EXPECT_NEAR(found.cos, std::cos(degrees * 3.14159265358979323846 / 180), 1e-14) << degrees;
  }
  EXPECT_EQ(sin_cos_degrees(180).sin, 0);
  EXPECT_EQ(sin_cos_degrees(-90).cos, 0);
}

void expect_near(Vec3d a, Vec3d b) {
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(a[k], b[k], 1e-12);
}

TEST(Camera, NamedViewsLookFromWhereTheyAreNamed) {
  const Box3d box{{-1, -1, -1}, {1, 1, 1}};
  const struct {
    const char* name;
    Vec3d from, up;
  } views[] = {{"front", {0, 0, 1}, {0, 1, 0}}, {"back", {0, 0, -1}, {0, 1, 0}}, {"right", {1, 0, 0}, {0, 1, 0}},
               {"left", {-1, 0, 0}, {0, 1, 0}}, {"top", {0, 1, 0}, {0, 0, -1}},  {"bottom", {0, -1, 0}, {0, 0, 1}}};
  for (const auto& view : views) {
    SCOPED_TRACE(view.name);
    const Camera camera = frame_bounds(box, named_view(view.name).value(), 1);
    expect_near(normalized(camera.eye), view.from);
    expect_near(camera.forward, -view.from);
    expect_near(camera.up, view.up);
    expect_near(camera.right, cross(camera.forward, camera.up));
  }
  EXPECT_FALSE(named_view("inside").has_value());
}

TEST(Camera, WithZUpTheFrontIsMinusY) {
  const Camera camera = frame_bounds({{-1, -1, -1}, {1, 1, 1}}, {0, 0}, 1, {}, {0, 0, 2});
  expect_near(camera.forward, {0, 1, 0});
  expect_near(camera.up, {0, 0, 1});
  expect_near(camera.right, {1, 0, 0});
}

// The farthest point from the middle of the picture, as a share of half its height or width.
double reach(const Camera& camera, const std::vector<Vec3d>& points, double aspect) {
  double reach = 0;
  for (const Vec3d& p : points) {
    const Vec3d q = p - camera.eye;
    const double depth = dot(q, camera.forward);
    EXPECT_GT(depth, camera.near_distance);
    const double half = camera.half_height * (camera.orthographic ? 1 : depth);
    reach = std::max({reach, std::abs(dot(q, camera.up)) / half, std::abs(dot(q, camera.right)) / (half * aspect)});
  }
  return reach;
}

TEST(Camera, FramesAllPointsAndNoMore) {
  std::vector<Vec3d> points;
  for (int i = 0; i < 60; ++i) points.push_back({std::sin(i) * 3 + 1e6, std::cos(2 * i), std::sin(5 * i) * 0.3});
  for (const bool orthographic : {false, true}) {
    for (const double aspect : {0.5, 1.0, 2.0}) {
      for (double azimuth = 0; azimuth < 360; azimuth += 50) {
        const Camera camera = frame_points(points, {azimuth, azimuth / 5 - 30}, aspect, {orthographic, 40});
        EXPECT_NEAR(reach(camera, points, aspect), 1 / 1.05, 1e-6);
      }
    }
  }
}

TEST(Camera, PointsLinesAndNothingCanBeFramed) {
  const std::vector<std::vector<Vec3d>> sets{{}, {{1, 2, 3}}, {{0, 0, 0}, {0, 0, 9}}, {{NAN, 0, 0}, {1, 1, 1}}};
  for (const auto& points : sets) {
    for (const bool orthographic : {false, true}) {
      const Camera camera = frame_points(points, {0, 0}, 1, {orthographic, 45});
      EXPECT_TRUE(is_finite(camera.eye));
      EXPECT_GT(camera.half_height, 0);
      EXPECT_GT(camera.near_distance, 0);
    }
  }
}

TEST(Camera, LooksAtItsTarget) {
  const Camera camera = look_at({1, 2, 3}, {1, 2, -5}, {0, 0, 1});  // up along the line of sight
  expect_near(camera.forward, {0, 0, -1});
  EXPECT_NEAR(dot(camera.up, camera.forward), 0, 1e-12);
  EXPECT_NEAR(length(camera.up), 1, 1e-12);
  EXPECT_NEAR(camera.half_height, std::tan(3.14159265358979323846 / 8), 1e-12);
}

}  // namespace
}  // namespace lodestone
