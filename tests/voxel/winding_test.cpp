#include "lodestone/voxel/winding.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "lodestone/core/model.h"
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
