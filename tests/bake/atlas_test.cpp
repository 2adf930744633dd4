#include "lodestone/bake/atlas.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "bake/shapes.h"
#include "lodestone/core/validate.h"

namespace lodestone::bake {
namespace {

Atlas made(const Mesh& mesh, const AtlasOptions& options = {}, int threads = 0) {
  Result<Atlas> atlas = make_atlas(mesh, options, Task::root({}, threads));
  EXPECT_TRUE(atlas) << atlas.error().line();
  return atlas ? std::move(*atlas) : Atlas{};
}

std::array<Vec2d, 3> corners(const Atlas& atlas, std::size_t triangle, double size) {
  const std::vector<float>& uv = test::floats(atlas.mesh, Semantic::uv);
  std::array<Vec2d, 3> out;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t w = atlas.mesh.triangles[triangle][k];
    out[k] = {double(uv[2 * w]) * size, double(uv[2 * w + 1]) * size};
  }
  return out;
}

double twice_area(Vec2d a, Vec2d b, Vec2d c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

// Calls use(triangle, pixel) for each pixel of a size x size raster whose centre is well inside a triangle.
template <class Use>
void rasterize(const Atlas& atlas, int size, Use&& use) {
  for (std::size_t t = 0; t < atlas.mesh.triangles.size(); ++t) {
    const auto [a, b, c] = corners(atlas, t, size);
    const auto [x0, x1] = std::minmax({a.x, b.x, c.x});
    const auto [y0, y1] = std::minmax({a.y, b.y, c.y});
    const double hand = twice_area(a, b, c) < 0 ? -1 : 1;
    for (int y = std::max(0, int(y0)); y <= std::min(size - 1, int(y1)); ++y) {
      for (int x = std::max(0, int(x0)); x <= std::min(size - 1, int(x1)); ++x) {
        const Vec2d p{x + 0.5, y + 0.5};
        const double inside =
            std::min({hand * twice_area(a, b, p), hand * twice_area(b, c, p), hand * twice_area(c, a, p)});
        if (inside > 1e-3) use(t, std::size_t(y) * std::size_t(size) + std::size_t(x));
      }
    }
  }
}

void expect_sound(const Mesh& mesh, const AtlasOptions& options) {
  const Atlas atlas = made(mesh, options);
  ASSERT_EQ(atlas.chart.size(), mesh.triangles.size());
  EXPECT_TRUE(validate(atlas.mesh));
  for (const std::uint32_t c : atlas.chart) EXPECT_LT(c, atlas.charts);
  for (const float x : test::floats(atlas.mesh, Semantic::uv)) {
    EXPECT_GE(x, 0);
    EXPECT_LE(x, 1);
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    EXPECT_EQ(atlas.mesh.vertices_of(t), mesh.vertices_of(t)) << "geometry stays";
    // Clockwise with v downward is counter-clockwise to the eye: no texture is mirrored.
    const auto [a, b, c] = corners(atlas, t, 1);
    EXPECT_LE(twice_area(a, b, c), 1e-7);
  }
  const int fine = 2 * static_cast<int>(options.texture_size);
  std::vector<std::uint8_t> covered(std::size_t(fine) * std::size_t(fine), 0);
  std::size_t twice = 0, all = 0;
  rasterize(atlas, fine, [&](std::size_t, std::size_t pixel) {
    twice += covered[pixel];
    covered[pixel] = 1;
    ++all;
  });
  EXPECT_EQ(twice, 0U);
  EXPECT_NEAR(static_cast<double>(all) / static_cast<double>(covered.size()), atlas.used, 0.03);
}

TEST(Atlas, lays_out_every_triangle_and_no_two_overlap) {
  expect_sound(test::sphere(24), {512, 4});
  expect_sound(test::torus(40), {512, 4});
  expect_sound(test::blob(32, 0.2), {512, 4});
  expect_sound(test::cube(), {64, 4});
}

TEST(Atlas, takes_any_mesh) {
  for (const test::Shape& shape : test::small_shapes()) {
    SCOPED_TRACE(shape.name);
    expect_sound(shape.make(), {512, 2});
  }
}

TEST(Atlas, splits_a_ramp_that_winds_over_itself) {
  // Two turns about z, a quarter up each: every face looks up, and the turns lie above each other.
  Mesh ramp;
  constexpr std::uint32_t kSteps = 128;
  for (std::uint32_t i = 0; i <= kSteps; ++i) {
    const double a = 4 * 3.14159265358979 * i / kSteps;
    for (const double r : {0.5, 1.0})
      ramp.positions.push_back(to_float({r * std::cos(a), r * std::sin(a), 0.5 * i / kSteps}));
  }
  for (std::uint32_t i = 0; i < kSteps; ++i) {
    ramp.triangles.push_back({2 * i, 2 * i + 1, 2 * i + 3});
    ramp.triangles.push_back({2 * i, 2 * i + 3, 2 * i + 2});
  }
  expect_sound(ramp, {256, 4});
  EXPECT_GE(made(ramp).charts, 2U);
}

TEST(Atlas, leaves_a_flat_fan_of_many_needles_whole) {
  constexpr std::uint32_t kSides = 20'000;
  Mesh fan;
  fan.positions.push_back({0, 0, 0});
  for (std::uint32_t i = 0; i < kSides; ++i) {
    const double a = 2 * 3.14159265358979 * i / kSides;
    fan.positions.push_back(to_float({std::cos(a), std::sin(a), 0}));
    fan.triangles.push_back({0, 1 + i, 1 + (i + 1) % kSides});
  }
  const Atlas atlas = made(fan);
  EXPECT_EQ(atlas.charts, 1U);
  EXPECT_GT(atlas.used, 0.7);
}

TEST(Atlas, a_cube_has_six_charts_and_a_sphere_few) {
  const Atlas cube = made(test::cube());
  EXPECT_EQ(cube.charts, 6U);
  EXPECT_GT(cube.used, 0.6);
  const Atlas sphere = made(test::sphere(40));
  EXPECT_LE(sphere.charts, 16U);
  EXPECT_GT(sphere.used, 0.5);
}

TEST(Atlas, splits_wedges_only_where_charts_meet) {
  for (const Mesh& mesh : {test::sphere(24), test::torus(30), test::blob(24, 0.02)}) {
    const Atlas atlas = made(mesh);
    std::vector<std::set<std::uint32_t>> charts(mesh.vertex_count()), wedges(mesh.vertex_count());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      for (const std::uint32_t w : atlas.mesh.triangles[t]) {
        charts[atlas.mesh.vertex_of(w)].insert(atlas.chart[t]);
        wedges[atlas.mesh.vertex_of(w)].insert(w);
      }
    }
    std::size_t inside = 0;
    for (std::size_t v = 0; v < charts.size(); ++v) {
      EXPECT_EQ(wedges[v].size(), charts[v].size());
      inside += charts[v].size() == 1 ? 1 : 0;
    }
    EXPECT_GT(inside, mesh.vertex_count() / 2);
  }
}

TEST(Atlas, keeps_the_gutter_between_charts) {
  constexpr int kSize = 256, kGutter = 6;
  const Atlas atlas = made(test::torus(40), {kSize, kGutter});
  std::vector<std::uint32_t> owner(std::size_t{kSize} * kSize, kNone);
  rasterize(atlas, kSize, [&](std::size_t t, std::size_t pixel) { owner[pixel] = atlas.chart[t]; });
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const std::uint32_t own = owner[std::size_t(y) * kSize + std::size_t(x)];
      if (own == kNone) continue;
      EXPECT_TRUE(x >= kGutter / 2 && y >= kGutter / 2 && x < kSize - kGutter / 2 && y < kSize - kGutter / 2);
      for (int v = y; v < std::min(kSize, y + kGutter); ++v) {
        for (int u = x; u < std::min(kSize, x + kGutter); ++u) {
          const std::uint32_t other = owner[std::size_t(v) * kSize + std::size_t(u)];
          ASSERT_TRUE(other == kNone || other == own) << x << ' ' << y << " and " << u << ' ' << v;
        }
      }
    }
  }
}

TEST(Atlas, keeps_other_attributes_and_leaves_out_stale_ones) {
  Mesh mesh = test::cube_with_seams();
  AttributeStream ids = make_stream("id", Semantic::categorical, 1, ComponentType::uint32, false, mesh.wedge_count());
  for (std::uint32_t w = 0; w < mesh.wedge_count(); ++w) std::get<std::vector<std::uint32_t>>(ids.values)[w] = w;
  mesh.attributes.push_back(std::move(ids));
  mesh.attributes.push_back(
      make_stream("TANGENT", Semantic::tangent, 4, ComponentType::float32, false, mesh.wedge_count()));
  const Atlas atlas = made(mesh);
  EXPECT_TRUE(validate(atlas.mesh));
  EXPECT_EQ(find_stream(atlas.mesh, Semantic::tangent), nullptr);
  EXPECT_EQ(std::count_if(atlas.mesh.attributes.begin(), atlas.mesh.attributes.end(),
                          [](const AttributeStream& s) { return s.semantic == Semantic::uv; }),
            1);
  const auto& kept = std::get<std::vector<std::uint32_t>>(find_stream(atlas.mesh, Semantic::categorical)->values);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(kept[atlas.mesh.triangles[t][k]], mesh.triangles[t][k]);
  }
}

TEST(Atlas, is_the_same_for_any_number_of_threads) {
  const Mesh mesh = test::blob(48, 0.1);
  const Atlas one = made(mesh, {}, 1);
  for (const int threads : {2, 7}) {
    const Atlas other = made(mesh, {}, threads);
    EXPECT_EQ(one.chart, other.chart);
    EXPECT_EQ(one.mesh.triangles, other.mesh.triangles);
    EXPECT_EQ(test::floats(one.mesh, Semantic::uv), test::floats(other.mesh, Semantic::uv));
  }
}

TEST(Atlas, says_what_does_not_fit) {
  EXPECT_EQ(make_atlas({}, {}).error().code, ErrorCode::empty);
  EXPECT_EQ(make_atlas(test::cube(), {8, 0}).error().code, ErrorCode::bad_argument);
  EXPECT_EQ(make_atlas(test::cube(), {64, 9}).error().code, ErrorCode::bad_argument);
  const auto crowded = make_atlas(test::canopy(400), {64, 8});
  ASSERT_FALSE(crowded);
  EXPECT_EQ(crowded.error().code, ErrorCode::bad_argument);
  EXPECT_NE(crowded.error().line().find("take a larger texture"), std::string::npos);
  Task task = Task::root({});
  task.cancel();
  EXPECT_EQ(make_atlas(test::cube(), {}, task).error().code, ErrorCode::cancelled);
}

}  // namespace
}  // namespace lodestone::bake
