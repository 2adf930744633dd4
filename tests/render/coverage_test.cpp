// Which samples see which triangle.
#include <gtest/gtest.h>

#include <rapidcheck.h>
#include <cmath>
#include <limits>

#include "render/support.h"

namespace lodestone {
namespace {

using test::flat_camera;
using test::frame_of;
using test::samples_of;
using test::scene_of;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// A flat grid over the whole picture, its inner vertices shaken but no triangle turned.
Mesh shaken_grid(int cells, float side, const std::vector<int>& shakes) {
  Mesh mesh = test::grid(cells);
  const float cell = side / static_cast<float>(cells);
  std::size_t next = 0;
  for (Vec3f& p : mesh.positions) {
    p = {p.x * side, p.y * side, 0};
    const auto inner = [&](float x) { return x > cell / 2 && x < side - cell / 2; };
    for (std::size_t k = 0; k < 2 && !shakes.empty(); ++k, ++next) {
      if (inner(p.x) && inner(p.y)) p[k] += cell * 0.004F * static_cast<float>(shakes[next % shakes.size()] % 50);
    }
  }
  return mesh;
}

TEST(Coverage, EverySampleOfACoveredSquareIsHitExactlyOnce) {
  for (const int samples : {1, 4}) {
    ASSERT_TRUE(rc::check("shared sides neither leak nor overlap", [samples](const std::vector<int>& shakes) {
      const std::uint32_t side = 40;
      const Mesh mesh = shaken_grid(*rc::gen::inRange(1, 6), static_cast<float>(side), shakes);
      std::vector<int> hits(std::size_t{side} * side);
      for (const Triangle& t : mesh.triangles) {
        Mesh one = mesh;
        one.triangles = {t};
        const render::Frame frame = frame_of(scene_of(one), flat_camera(side), side, samples);
        for (std::size_t i = 0; i < hits.size(); ++i) hits[i] += frame.coverage[i];
      }
      for (const int hit : hits) RC_ASSERT(hit == samples);
      const render::Frame all = frame_of(scene_of(mesh), flat_camera(side), side, samples);
      RC_ASSERT(samples_of(all) == hits.size() * static_cast<std::size_t>(samples));
    }));
  }
}

TEST(Coverage, LargeTrianglesMeetAsSmallOnesDo) {
  const std::uint32_t side = 300;
  const Mesh mesh = shaken_grid(2, static_cast<float>(side), {3, 47, 11, 29});
  std::size_t hits = 0;
  for (const Triangle& t : mesh.triangles) {
    Mesh one = mesh;
    one.triangles = {t};
    hits += samples_of(frame_of(scene_of(one), flat_camera(side), side));
  }
  EXPECT_EQ(hits, std::size_t{side} * side * 4);
  EXPECT_EQ(samples_of(frame_of(scene_of(mesh), flat_camera(side), side)), hits);
}

TEST(Coverage, IsTheArea) {
  const std::uint32_t side = 256;
  for (const float size : {3.0F, 20.0F, 63.0F, 65.0F, 200.0F}) {
    const Mesh mesh =
        test::make_mesh({{10.3F, 9.1F, 0}, {10.3F + size, 14.7F, 0}, {17.2F, 9.1F + size, 0}}, {{0, 1, 2}});
    const double area = area_of(mesh), outline = 4 * static_cast<double>(size);
    for (const int samples : {1, 4}) {
      const auto hit = static_cast<double>(samples_of(frame_of(scene_of(mesh), flat_camera(side), side, samples)));
      EXPECT_NEAR(hit / samples, area, 0.05 * outline + 1) << size;
    }
  }
}

TEST(Coverage, DepthAndTriangleAreOfTheNearest) {
  Mesh mesh = test::square(8);
  mesh.positions.insert(mesh.positions.end(), {{0, 0, 2}, {8, 0, 2}, {0, 8, 2}});
  mesh.triangles.push_back({4, 5, 6});
  const render::Frame frame = frame_of(scene_of(mesh), flat_camera(8), 8);
  const std::size_t lower_left = std::size_t{7} * 8, upper_right = 7;
  EXPECT_EQ(frame.triangle[lower_left], 2U);
  EXPECT_NEAR(frame.depth[lower_left], 6, 1e-4);
  EXPECT_LT(frame.triangle[upper_right], 2U);
  EXPECT_NEAR(frame.depth[upper_right], 8, 1e-4);
}

TEST(Coverage, DoesNotDependOnThreads) {
  const render::Scene scene = scene_of(test::torus(60));
  const Camera camera = scene.framed({30, 40}, 1);
  const auto with = [&](int threads) {
    return std::move(render::rasterize(scene, camera, 200, 200, 4, Task::root({}, threads)).value());
  };
  const render::Frame one = with(1);
  for (const int threads : {2, 7}) {
    const render::Frame other = with(threads);
    EXPECT_EQ(one.coverage, other.coverage);
    EXPECT_EQ(one.depth, other.depth);
    EXPECT_EQ(one.triangle, other.triangle);
  }
}

TEST(Coverage, FarFromTheOriginLooksTheSame) {
  const std::uint32_t side = 128;
  Mesh mesh = test::torus(40);
  const render::Scene near_scene = scene_of(mesh);
  mesh.offset = {1e6, -2e6, 3e6};
  const render::Scene far_scene = scene_of(mesh);
  const render::Frame a = frame_of(near_scene, near_scene.framed({20, 15}, 1), side);
  const render::Frame b = frame_of(far_scene, far_scene.framed({20, 15}, 1), side);
  std::size_t different = 0;
  for (std::size_t i = 0; i < a.coverage.size(); ++i) different += a.coverage[i] != b.coverage[i] ? 1 : 0;
  EXPECT_LT(different, 8U);
}

// A floor that reaches beyond the horizon, behind the eye too.
Mesh floor(float size) {
  return test::make_mesh({{-size, 0, -size}, {size, 0, -size}, {size, 0, size}, {-size, 0, size}},
                         {{0, 2, 1}, {0, 3, 2}});
}

TEST(Coverage, WhatIsBehindTheEyeIsCutOff) {
  const std::uint32_t side = 64;
  for (const float size : {30.0F, 1e4F, 1e9F, 1e18F}) {
    const render::Scene scene = scene_of(floor(size));
    const render::Frame frame = frame_of(scene, look_at({0, 1, 0}, {0, 1, -1}), side);
    for (std::uint32_t x = 0; x < side; ++x) {
      const auto at = [&](std::uint32_t y) { return std::size_t{y} * side + x; };
      EXPECT_EQ(frame.coverage[at(side / 2 - 1)], 0) << size;
      for (const std::uint32_t y : {side / 2 + 8, side - 1}) {
        ASSERT_EQ(frame.coverage[at(y)], 4) << size << " " << x << " " << y;
        // Of the lowest sample, seven eighths down the pixel.
        const double slope = (y + 0.875 - side / 2.0) / (side / 2.0) * 0.41421356;
        EXPECT_NEAR(frame.depth[at(y)] * slope, 1, 1e-3) << size;
      }
    }
  }
}

TEST(Coverage, TurnedAwayAndWithoutAreaIsNothing) {
  const std::uint32_t side = 32;
  const render::Scene scene = scene_of(test::square(32));
  EXPECT_EQ(samples_of(frame_of(scene, look_at({16, 16, 8}, {16, 16, 20}), side)), 0U);
  const Mesh thin =
      test::make_mesh({{1, 1, 0}, {30, 30, 0}, {10, 10, 0}, {5, 5, 0}}, {{0, 1, 2}, {3, 3, 3}, {0, 1, 1}});
  EXPECT_EQ(samples_of(frame_of(scene_of(thin), flat_camera(side), side)), 0U);
}

// Numbers that are none are refused: entries_test.cpp.
TEST(Coverage, PositionsAsFarAsFloatsGoDoNoHarm) {
  const std::uint32_t side = 32;
  Mesh mesh = test::square(32);
  mesh.positions.insert(mesh.positions.end(), {{5, 5, 3e38F}, {5, 5, -3e38F}});
  mesh.triangles.insert(mesh.triangles.end(), {{0, 1, 4}, {1, 5, 2}});
  const render::Scene scene = scene_of(mesh);
  EXPECT_EQ(samples_of(frame_of(scene, flat_camera(side), side)), std::size_t{side} * side * 4);
  EXPECT_TRUE(is_finite(scene.bounds().max));
}

TEST(Coverage, NamesTheInstance) {
  Model model = make_model(test::square(8));
  model.instances.push_back({0, Mat4d::translation({8, 0, 0}), "second"});
  const render::Scene scene = scene_of(model);
  const render::Frame frame = frame_of(scene, flat_camera(16), 16);
  const std::size_t lowest_row = std::size_t{15} * 16;
  EXPECT_EQ(scene.instance_of(frame.triangle[lowest_row]), 0U);
  EXPECT_EQ(scene.instance_of(frame.triangle[lowest_row + 15]), 1U);
}

TEST(Coverage, RefusesWhatCanNotBe) {
  const render::Scene scene = scene_of(test::cube());
  const auto code = [&](const Camera& camera, std::uint32_t width, int samples) {
    const Result<render::Frame> frame = render::rasterize(scene, camera, width, 10, samples);
    return frame ? ErrorCode::empty : frame.error().code;
  };
  const Camera good = scene.framed({0, 0}, 1);
  EXPECT_EQ(code(good, 0, 4), ErrorCode::bad_argument);
  EXPECT_EQ(code(good, render::kMostSide + 1, 4), ErrorCode::bad_argument);
  EXPECT_EQ(code(good, 10, 3), ErrorCode::bad_argument);
  Camera bad = good;
  bad.eye.x = static_cast<double>(kNan);
  EXPECT_EQ(code(bad, 10, 4), ErrorCode::bad_argument);
  bad = good;
  bad.half_height = 0;
  EXPECT_EQ(code(bad, 10, 4), ErrorCode::bad_argument);
}

}  // namespace
}  // namespace lodestone
