#include "lodestone/voxel/surface_voxels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "lodestone/core/model.h"
#include "lodestone/core/topology.h"
#include "lodestone/math/triangle.h"
#include "lodestone/spatial/surface.h"
#include "lodestone/voxel/boolean.h"
#include "lodestone/voxel/isosurface.h"
#include "lodestone/voxel/morphology.h"
#include "lodestone/voxel/resample.h"
#include "lodestone/voxel/slab_surface.h"
#include "lodestone/voxel/voxelize.h"
#include "support/shapes.h"

namespace lodestone::voxel {
namespace {

spatial::Surface surface_of(const Mesh& mesh) { return *spatial::flatten(make_model(mesh)); }

// Every point of the surface lies in a voxel that is set, and every voxel that is set is as near as its half diagonal.
TEST(SurfaceVoxels, are_where_the_surface_is) {
  const Mesh mesh = test::soup(4, 30, 12);
  const spatial::Surface surface = surface_of(mesh);
  const VoxelGrid grid = *grid_around(surface.bounds, 40);
  const auto voxels = surface_voxels(surface, grid);
  ASSERT_TRUE(voxels);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> share(0, 1);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto [a, b, c] = surface.corners(t);
    for (int i = 0; i < 300; ++i) {
      double u = share(random), v = share(random);
      if (u + v > 1) {
        u = 1 - u;
        v = 1 - v;
      }
      const Vec3d p = a + (b - a) * u + (c - a) * v;
      std::uint32_t at[3];
      for (std::size_t k = 0; k < 3; ++k) at[k] = static_cast<std::uint32_t>((p[k] - grid.origin[k]) / grid.spacing[k]);
      EXPECT_TRUE(voxels->at(at[0], at[1], at[2]));
    }
  }
  const double half = std::sqrt(3.0) / 2 * grid.spacing.x * 1.0001;
  for (std::uint32_t z = 0; z < grid.size[2]; ++z) {
    for (std::uint32_t y = 0; y < grid.size[1]; ++y) {
      for (std::uint32_t x = 0; x < grid.size[0]; ++x) {
        if (!voxels->at(x, y, z)) continue;
        const Vec3d p = grid.point({x + 0.5, y + 0.5, z + 0.5});
        double nearest = 1e9;
        for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
          const auto [a, b, c] = surface.corners(t);
          nearest = std::min(nearest, length(closest_point(p, a, b, c).point - p));
        }
        EXPECT_LE(nearest, half);
      }
    }
  }
}

// A closed surface parts inside from outside, whichever its thickness; the thinner one has fewer voxels.
TEST(SurfaceVoxels, separate) {
  const spatial::Surface surface = surface_of(test::sphere(24));
  const VoxelGrid grid = *grid_around(surface.bounds, 40, 2);
  std::uint64_t counts[2];
  for (const Thickness thickness : {Thickness::conservative, Thickness::separating_6}) {
    const auto walls = surface_voxels(surface, grid, thickness);
    ASSERT_TRUE(walls);
    counts[thickness == Thickness::separating_6] = walls->set_count();
    const BitVolume outside = flooded_from_outside(*walls);
    EXPECT_FALSE(outside.at(grid.size[0] / 2, grid.size[1] / 2, grid.size[2] / 2)) << "no path over sides leads in";
  }
  EXPECT_LT(counts[1], counts[0]);
}

// A sphere without its top: a hole of radius 0.4.
Mesh bowl() {
  Mesh out = test::sphere(40);
  std::erase_if(out.triangles, [&](const Triangle& t) {
    const auto top = [&](std::uint32_t v) { return out.positions[v].z > 0.91F; };
    return top(t[0]) && top(t[1]) && top(t[2]);
  });
  return out;
}

TEST(Shrinkwrap, closes_holes_up_to_twice_the_radius) {
  const spatial::Surface surface = surface_of(bowl());
  for (const auto& [radius, closed] : {std::pair(0.6, true), std::pair(0.1, false)}) {
    const VoxelGrid grid = *grid_around(surface.bounds, 60, 20);
    const auto solid = shrinkwrap(surface, grid, radius / grid.spacing.x);
    ASSERT_TRUE(solid);
    EXPECT_EQ(solid->at(grid.size[0] / 2, grid.size[1] / 2, grid.size[2] / 2), closed) << radius;
  }
  EXPECT_FALSE(shrinkwrap(surface, *grid_around(surface.bounds, 60, 20), 1000));
}

TEST(Booleans, are_those_of_sets) {
  VoxelGrid grid;
  grid.size = {70, 3, 2};
  BitVolume a(grid), b(grid);
  std::mt19937 random(2);
  for (std::uint32_t x = 0; x < 70; ++x) {
    if (random() % 2) a.set(x, x % 3, x % 2);
    if (random() % 2) b.set(x, x % 3, x % 2);
  }
  for (const auto operation : {BooleanOperation::unite, BooleanOperation::intersect, BooleanOperation::subtract}) {
    BitVolume c = a;
    ASSERT_TRUE(combine(c, b, operation));
    for (std::uint32_t x = 0; x < 70; ++x) {
      const bool in_a = a.at(x, x % 3, x % 2), in_b = b.at(x, x % 3, x % 2);
      const bool wanted = operation == BooleanOperation::unite       ? in_a || in_b
                          : operation == BooleanOperation::intersect ? in_a && in_b
                                                                     : in_a && !in_b;
      EXPECT_EQ(c.at(x, x % 3, x % 2), wanted);
    }
  }
  grid.origin.x = 1;
  EXPECT_FALSE(combine(a, BitVolume(grid), BooleanOperation::unite));
}

// The same cubes are cut as by the whole volume; slabs leave no trace.
TEST(SlabSurface, has_the_triangles_of_the_whole) {
  const spatial::Surface surface = surface_of(test::torus(24));
  for (const std::uint32_t ratio : {1U, 2U}) {
    VoxelGrid grid = *grid_around(surface.bounds, 64, 2);
    for (std::size_t k = 0; k < 3; ++k) grid.size[k] = grid.size[k] / ratio * ratio;
    const std::array<std::uint32_t, 3> size{grid.size[0] / ratio, grid.size[1] / ratio, grid.size[2] / ratio};
    const auto slabs = slab_surface(surface, grid, size);
    ASSERT_TRUE(slabs);
    const auto solid = voxelize(surface, grid);
    const auto whole = isosurface(*downsample(solid->volume, size), {127.5});
    ASSERT_TRUE(whole);
    EXPECT_EQ(slabs->mesh.triangles, whole->triangles);
    EXPECT_EQ(slabs->voxels_inside, solid->volume.set_count());
    const Topology t = topology_of(slabs->mesh);
    EXPECT_TRUE(t.closed && t.manifold);
    EXPECT_EQ(t.vertices + t.triangles, t.edges) << "of genus 1";
  }
  EXPECT_FALSE(slab_surface(surface, *grid_around(surface.bounds, 64, 2), {63, 3, 3}));
}

TEST(Downsample, keeps_thin_parts_on_request) {
  VoxelGrid grid;
  grid.size = {64, 16, 16};
  BitVolume wire(grid);
  for (std::uint32_t x = 2; x < 62; ++x) wire.set(x, 5, 5);
  const auto usual = downsample(wire, {16, 4, 4});
  const auto thin = downsample_thin(wire, {16, 4, 4});
  ASSERT_TRUE(usual && thin);
  EXPECT_FALSE(isosurface(*usual, {127.5})) << "a sixteenth of each voxel";
  const auto mesh = isosurface(*thin, {127.5});
  ASSERT_TRUE(mesh);
  EXPECT_EQ(topology_of(*mesh).components, 1U);
  EXPECT_NEAR(bounds_of(*mesh).size().x, 64, 4);
}

}  // namespace
}  // namespace lodestone::voxel
