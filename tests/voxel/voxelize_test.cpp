#include "lodestone/voxel/voxelize.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "lodestone/core/model.h"
#include "support/shapes.h"

namespace lodestone::voxel {
namespace {

spatial::Surface surface_of(const Mesh& mesh) { return *spatial::flatten(make_model(mesh)); }

Mesh scaled(Mesh mesh, Vec3f by, Vec3f plus) {
  for (Vec3f& p : mesh.positions) p = {p.x * by.x + plus.x, p.y * by.y + plus.y, p.z * by.z + plus.z};
  return mesh;
}

VoxelGrid unit_grid(std::uint32_t n) { return {{n, n, n}, {}, {1, 1, 1}}; }

BitVolume filled(const Mesh& mesh, const VoxelGrid& grid, FillRule fill = FillRule::parity) {
  const auto out = voxelize(surface_of(mesh), grid, {fill});
  EXPECT_TRUE(out);
  EXPECT_EQ(out->leaking_columns, 0U);
  return out->volume;
}

// All faces lie on centres of voxels: the half-open rule takes one side of each pair.
TEST(Voxelize, box_with_its_faces_on_centres) {
  const Mesh box = scaled(test::cube(), {10, 10, 10}, {10.5F, 10.5F, 10.5F});
  for (const FillRule fill : {FillRule::parity, FillRule::nonzero}) {
    EXPECT_EQ(filled(box, unit_grid(32), fill).set_count(), 1000U);
  }
}

// The cases of [voxel-lod], table 2-1, of a triangle and a plane of samples, on closed shapes: (a) no corner on it, (b)
// one corner on it and the far side across, (c) one corner touching, (d) a side on it, (e) all of it.
TEST(Voxelize, corners_sides_and_faces_on_planes_of_samples) {
  const Mesh tetrahedron =
      test::make_mesh({{2.5F, 2.5F, 2.5F}, {12.5F, 2.5F, 2.5F}, {2.5F, 12.5F, 2.5F}, {2.5F, 2.5F, 12.5F}},
                      {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}});
  const std::uint64_t count = filled(tetrahedron, unit_grid(16)).set_count();
  // 10 * 11 * 12 / 6 voxels if all borders belonged to it, 8 * 9 * 10 / 6 if none did.
  EXPECT_GE(count, 120U);
  EXPECT_LE(count, 220U);
  // Moved off the planes: points i, j, k from 0 with i + j + k <= 7.
  EXPECT_EQ(filled(scaled(tetrahedron, {1, 1, 1}, {0.3F, 0.2F, 0.1F}), unit_grid(16)).set_count(), 120U);
}

// Stars of triangles around a middle, corners snapped to centres of voxels: closed, often folded, full of cases where
// lines run through corners and along sides. No line may end up inside.
TEST(Voxelize, closed_surfaces_never_leak) {
  std::mt19937 random(7);
  for (int run = 0; run < 300; ++run) {
    Mesh mesh = run % 2 == 0 ? test::sphere(4) : test::torus(6);
    for (Vec3f& p : mesh.positions) {
      for (std::size_t k = 0; k < 3; ++k) p[k] = static_cast<float>(random() % 12) + 2.5F;
    }
    const auto out = voxelize(surface_of(mesh), unit_grid(16));
    ASSERT_TRUE(out);
    EXPECT_EQ(out->leaking_columns, 0U) << run;
  }
}

// The half-open rule is that of a line moved by next to nothing, to +x first and to -y less.
bool inside_by_rays(const Mesh& mesh, Vec3d p) {
  p.x += 1e-6;
  p.y -= 1e-9;
  int crossings = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle v = mesh.vertices_of(t);
    const Vec3d a = mesh.position(v[0]), b = mesh.position(v[1]), c = mesh.position(v[2]);
    const auto side = [&](Vec3d s, Vec3d e) { return (e.x - s.x) * (p.y - s.y) - (e.y - s.y) * (p.x - s.x); };
    const double ab = side(a, b), bc = side(b, c), ca = side(c, a);
    if (!((ab > 0 && bc > 0 && ca > 0) || (ab < 0 && bc < 0 && ca < 0))) continue;
    const double z = (a.z * bc + b.z * ca + c.z * ab) / (ab + bc + ca);
    crossings += z < p.z ? 1 : 0;
  }
  return crossings % 2 == 1;
}

// Corners at 1/256 of a voxel are not rounded: what a ray says is exact.
TEST(Voxelize, agrees_with_counting_rays) {
  std::mt19937 random(11);
  for (int run = 0; run < 60; ++run) {
    Mesh mesh = run % 2 == 0 ? test::sphere(3) : test::torus(4);
    for (Vec3f& p : mesh.positions) {
      p.x = static_cast<float>(random() % 40) / 4 + 2.0625F + static_cast<float>(random() % 7) / 64;
      p.y = static_cast<float>(random() % 40) / 4 + 2.03125F + static_cast<float>(random() % 5) / 64;
      p.z = static_cast<float>(random() % 40) / 4 + 2.1F;
    }
    const BitVolume volume = filled(mesh, unit_grid(14));
    std::uint64_t differ = 0;
    for (std::uint32_t z = 0; z < 14; ++z) {
      for (std::uint32_t y = 0; y < 14; ++y) {
        for (std::uint32_t x = 0; x < 14; ++x) {
          const bool want = inside_by_rays(mesh, {x + 0.5, y + 0.5, z + 0.5});
          differ += volume.at(x, y, z) != want ? 1U : 0U;
        }
      }
    }
    EXPECT_LE(differ, 2U) << run;  // depths that are rounded beside a centre
  }
}

TEST(Voxelize, volume_of_a_sphere_at_any_aspect) {
  const Mesh sphere = test::sphere(60);
  Box3d box;
  box.add(Vec3d{-1, -1, -1});
  box.add(Vec3d{1, 1, 1});
  const auto grid = grid_over(box, {100, 37, 61});
  ASSERT_TRUE(grid);
  const auto count = static_cast<double>(filled(sphere, *grid).set_count());
  const double voxel = grid->spacing.x * grid->spacing.y * grid->spacing.z;
  EXPECT_NEAR(count * voxel, volume_of(sphere), 0.01 * volume_of(sphere));
}

TEST(Voxelize, hollow_and_overlapping_solids) {
  const auto merged = [](Mesh a, const Mesh& b, bool turned) {
    const auto first = static_cast<std::uint32_t>(a.positions.size());
    a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
    for (Triangle t : b.triangles) {
      if (turned) std::swap(t[1], t[2]);
      a.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    }
    return a;
  };
  const Mesh outer = scaled(test::cube(), {12, 12, 12}, {2, 2, 2}), inner = scaled(test::cube(), {6, 6, 6}, {5, 5, 5});
  const Mesh beside = scaled(test::cube(), {12, 12, 12}, {8, 2, 2});
  for (const FillRule fill : {FillRule::parity, FillRule::nonzero}) {
    EXPECT_EQ(filled(merged(outer, inner, true), unit_grid(24), fill).set_count(), 1728U - 216U);
  }
  EXPECT_EQ(filled(merged(outer, beside, false), unit_grid(24), FillRule::nonzero).set_count(), 18U * 144U);
  EXPECT_EQ(filled(merged(outer, beside, false), unit_grid(24), FillRule::parity).set_count(), 12U * 144U);
}

TEST(Voxelize, open_surfaces_leak_and_say_so) {
  const auto out = voxelize(surface_of(scaled(test::grid(2), {8, 8, 1}, {2, 2, 3})), unit_grid(12));
  ASSERT_TRUE(out);
  EXPECT_EQ(out->leaking_columns, 64U);
}

TEST(Voxelize, parts_outside_of_the_grid_count) {
  const Mesh large = scaled(test::cube(), {100, 100, 100}, {-50, -50, -50});
  const auto out = voxelize(surface_of(large), unit_grid(8));
  EXPECT_EQ(out->volume.set_count(), 512U);
  const Mesh huge = scaled(test::cube(), {1e30F, 1e30F, 1e30F}, {-5e29F, -5e29F, -5e29F});
  EXPECT_TRUE(voxelize(surface_of(huge), unit_grid(8)));
}

TEST(Voxelize, same_bits_for_any_thread_count) {
  const spatial::Surface torus = surface_of(test::torus(80));
  const VoxelGrid grid = *grid_around(torus.bounds, 150);
  for (const FillRule fill : {FillRule::parity, FillRule::nonzero}) {
    EXPECT_EQ(voxelize(torus, grid, {fill}, Task::root({}, 1))->volume.words,
              voxelize(torus, grid, {fill}, Task::root({}, 7))->volume.words);
  }
}

TEST(Voxelize, grids_that_can_not_be) {
  Box3d box;
  box.add(Vec3d{0, 0, 0});
  EXPECT_EQ(grid_around(box, 100).error().code, ErrorCode::bad_argument);
  box.add(Vec3d{1, 2, 3});
  EXPECT_EQ(grid_around(box, 2).error().code, ErrorCode::bad_argument);
  EXPECT_EQ(grid_around(box, 70'000).error().code, ErrorCode::bad_argument);
  EXPECT_EQ(grid_over(box, {0, 1, 1}).error().code, ErrorCode::bad_argument);
  const auto grid = grid_around(box, 32);
  EXPECT_EQ(grid->size[2], 32U);
  EXPECT_EQ(grid->size[0], 12U);
  EXPECT_EQ(voxelize(surface_of(test::cube()), {}).error().code, ErrorCode::bad_argument);
}

}  // namespace
}  // namespace lodestone::voxel
