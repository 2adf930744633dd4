#include "lodestone/voxel/winding.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

#include "lodestone/core/model.h"
#include "lodestone/voxel/caps_detail.h"
#include "lodestone/voxel/voxelize.h"
#include "support/shapes.h"

namespace lodestone::voxel {
namespace {

spatial::Surface surface_of(const Mesh& mesh) { return *spatial::flatten(make_model(mesh)); }

TEST(WindingNumber, is_one_inside_and_zero_outside) {
  const spatial::Surface sphere = surface_of(test::sphere(40));
  const WindingNumber winding(sphere);
  std::mt19937 random(5);
  for (int i = 0; i < 2000; ++i) {
    Vec3d p;
    for (std::size_t k = 0; k < 3; ++k) p[k] = static_cast<double>(random() % 2000) / 500 - 2;
    const double r = length(p);
    if (std::abs(r - 1) < 0.02) continue;
    EXPECT_NEAR(winding.at(p), r < 1 ? 1 : 0, 0.05) << r;
  }
}

TEST(WindingNumber, of_half_a_sphere_is_a_half_in_its_middle) {
  Mesh half = test::sphere(40);
  std::erase_if(half.triangles, [&](const Triangle& t) {
    return half.positions[t[0]].z + half.positions[t[1]].z + half.positions[t[2]].z < 0;
  });
  const spatial::Surface surface = surface_of(half);
  EXPECT_NEAR(WindingNumber(surface).at({0, 0, 0}), 0.5, 0.03);
}

TEST(WindingNumber, of_single_and_flat_triangles) {
  const spatial::Surface one = surface_of(test::make_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}));
  EXPECT_NEAR(WindingNumber(one).at({0.25, 0.25, -1e-6}), 0.5, 1e-3);
  EXPECT_NEAR(WindingNumber(one).at({0.25, 0.25, 1e-6}), -0.5, 1e-3);
  const spatial::Surface point = surface_of(test::make_mesh({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, {{0, 1, 2}}));
  EXPECT_EQ(WindingNumber(point).at({0, 0, 0}), 0);
  EXPECT_TRUE(std::isfinite(WindingNumber(point).at({1, 1, 1})));
}

// A lattice off the grid: planes through voxels' centres are a matter of taste.
float lattice(std::mt19937& random, unsigned places) {
  return static_cast<float>(random() % places) + 0.013F * static_cast<float>(random() % 7);
}

// Triangles between a few random points: repeated, turned over, without area, at one place.
Mesh soup(std::uint32_t seed, std::size_t triangles) {
  std::mt19937 random(seed);
  std::vector<Vec3f> points;
  for (int i = 0; i < 24; ++i) {
    points.push_back({lattice(random, 4), lattice(random, 4), lattice(random, 3)});
  }
  std::vector<Triangle> faces;
  const auto any = [&] { return static_cast<std::uint32_t>(random() % points.size()); };
  for (std::size_t i = 0; i < triangles; ++i) faces.push_back({any(), any(), any()});
  return test::make_mesh(points, faces);
}

TEST(Caps, close_whatever_there_is) {
  EXPECT_TRUE(detail::caps_of(surface_of(test::sphere(20)), {}).empty());
  for (std::uint32_t seed = 0; seed < 50; ++seed) {
    spatial::Surface surface = surface_of(soup(seed, 1 + seed));
    const std::vector<Triangle> caps = detail::caps_of(surface, {});
    surface.triangles.insert(surface.triangles.end(), caps.begin(), caps.end());
    std::map<std::array<std::array<double, 3>, 2>, int> walked;
    const auto place = [&](std::uint32_t v) {
      const Vec3d& p = surface.positions[v];
      return std::array<double, 3>{p.x, p.y, p.z};
    };
    for (const Triangle& t : surface.triangles) {
      for (std::size_t k = 0; k < 3; ++k) {
        const auto a = place(t[k]), b = place(t[(k + 1) % 3]);
        walked[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : a > b ? -1 : 0;
      }
    }
    for (const auto& [edge, sum] : walked) EXPECT_EQ(sum, 0) << seed;
  }
}

// Filled is what a sum over all triangles says, where it is beyond doubt, but for centres of voxels within 1/512 voxel
// of a triangle and what a line's ends and middle don't show.
TEST(Voxelize, winding_of_soups_is_that_of_all_triangles) {
  std::size_t doubtful = 0, wrong = 0, looked_at = 0;
  for (std::uint32_t seed = 0; seed < 30; ++seed) {
    const spatial::Surface surface = surface_of(soup(100 + seed, 4 + 2 * seed));
    const VoxelGrid grid = *grid_around(surface.bounds, 19);
    const auto made = voxelize(surface, grid, {FillRule::winding});
    ASSERT_TRUE(made);
    for (std::uint32_t z = 0; z < grid.size[2]; ++z) {
      for (std::uint32_t y = 0; y < grid.size[1]; ++y) {
        for (std::uint32_t x = 0; x < grid.size[0]; ++x) {
          const Vec3d p = grid.point({x + 0.5, y + 0.5, z + 0.5});
          double sum = 0;
          for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
            auto [a, b, c] = surface.corners(t);
            a = a - p, b = b - p, c = c - p;
            const double la = length(a), lb = length(b), lc = length(c);
            sum += std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
          }
          const double winding = std::abs(sum) / (2 * 3.14159265358979323846);
          ++looked_at;
          if (std::abs(winding - 0.5) < 0.1) {
            ++doubtful;
          } else {
            wrong += made->volume.at(x, y, z) != (winding > 0.5) ? 1 : 0;
          }
        }
      }
    }
  }
  EXPECT_LT(doubtful, looked_at / 4);
  EXPECT_LT(wrong, looked_at / 2000);
}

// A sphere with a hole is filled like the whole one, but around the hole; turned inside out as well.
TEST(Voxelize, winding_fills_what_has_holes) {
  Mesh open = test::sphere(40);
  std::erase_if(open.triangles, [&](const Triangle& t) { return open.positions[t[0]].z > 0.95F; });
  Mesh turned = open;
  for (Triangle& t : turned.triangles) std::swap(t[1], t[2]);
  const spatial::Surface whole = surface_of(test::sphere(40));
  const VoxelGrid grid = *grid_around(whole.bounds, 50);
  const auto count = static_cast<double>(voxelize(whole, grid)->volume.set_count());
  const auto with_hole = voxelize(surface_of(open), grid, {FillRule::winding});
  ASSERT_TRUE(with_hole);
  EXPECT_NEAR(static_cast<double>(with_hole->volume.set_count()), count, 0.01 * count);
  EXPECT_EQ(voxelize(surface_of(turned), grid, {FillRule::winding})->volume.words, with_hole->volume.words);
  EXPECT_EQ(voxelize(surface_of(open), grid, {FillRule::winding}, Task::root({}, 1))->volume.words,
            with_hole->volume.words);
}

}  // namespace
}  // namespace lodestone::voxel
