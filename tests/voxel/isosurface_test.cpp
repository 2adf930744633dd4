#include "lodestone/voxel/isosurface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "lodestone/core/topology.h"
#include "support/shapes.h"

namespace lodestone::voxel {
namespace {

template <class T>
ScalarVolume<T> volume_of(std::array<std::uint32_t, 3> size, const std::function<double(Vec3d)>& value) {
  ScalarVolume<T> out;
  out.grid.size = size;
  for (std::uint32_t z = 0; z < size[2]; ++z) {
    for (std::uint32_t y = 0; y < size[1]; ++y) {
      for (std::uint32_t x = 0; x < size[0]; ++x) {
        out.values.push_back(static_cast<T>(value({x + 0.5, y + 0.5, z + 0.5})));
      }
    }
  }
  return out;
}

double ball(Vec3d p) { return 10 - length(p - Vec3d{16, 16, 16}); }

TEST(Isosurface, of_a_ball) {
  const auto mesh = isosurface(volume_of<float>({32, 32, 32}, ball), {0});
  ASSERT_TRUE(mesh);
  const Topology t = topology_of(*mesh);
  EXPECT_TRUE(t.closed && t.manifold);
  EXPECT_EQ(t.components, 1U);
  EXPECT_EQ(t.inconsistent_edges + t.duplicate_faces + t.degenerate_triangles, 0U);
  EXPECT_EQ(t.vertices + t.triangles, t.edges + 2);
  EXPECT_NEAR(lodestone::volume_of(*mesh), 4.0 / 3 * 3.14159265 * 1000, 30);  // outward, as it is above 0
  for (std::uint32_t v = 0; v < mesh->vertex_count(); ++v) {
    EXPECT_NEAR(length(mesh->position(v) - Vec3d{16, 16, 16}), 10, 0.05);
  }
}

// All that the table of cases promises: every edge has two triangles, the other way round each, whatever the values.
TEST(Isosurface, of_noise_is_closed_everywhere) {
  std::mt19937 random(3);
  for (const std::array<std::uint32_t, 3>& size :
       {std::array<std::uint32_t, 3>{17, 13, 11}, {64, 5, 6}, {63, 4, 4}, {62, 4, 4}, {1, 1, 1}, {130, 3, 2}}) {
    const auto noise = volume_of<std::uint8_t>(size, [&](Vec3d) { return random() % 256; });
    const auto mesh = isosurface(noise, {127.5});
    if (!mesh) continue;  // a single voxel may be outside
    const Topology t = topology_of(*mesh);
    EXPECT_TRUE(t.closed) << size[0];
    EXPECT_EQ(t.boundary_edges + t.nonmanifold_edges + t.inconsistent_edges, 0U) << size[0];
    EXPECT_EQ(t.vertices, mesh->vertex_count()) << "no vertex is for nothing";
  }
}

TEST(Isosurface, closes_half_a_voxel_behind_the_volume) {
  const auto mesh = isosurface(volume_of<std::uint16_t>({4, 3, 2}, [](Vec3d) { return 1000.0; }), {500});
  ASSERT_TRUE(mesh);
  const Box3d box = bounds_of(*mesh);
  EXPECT_EQ(box.min, (Vec3d{0, 0, 0}));
  EXPECT_EQ(box.max, (Vec3d{4, 3, 2}));
}

TEST(Isosurface, of_anisotropic_voxels_lies_in_model_units) {
  auto volume = volume_of<float>({32, 32, 32}, ball);
  volume.grid.origin = {1000, -5, 7};
  volume.grid.spacing = {0.5, 2, 3};
  const auto mesh = isosurface(volume, {0});
  ASSERT_TRUE(mesh);
  const Box3d box = bounds_of(*mesh);
  EXPECT_NEAR(box.center().x, 1008, 0.01);
  EXPECT_NEAR(box.size().x, 10, 0.1);
  EXPECT_NEAR(box.size().z, 60, 0.6);
}

TEST(Isosurface, whole_numbers_and_their_ends) {
  const auto steps = volume_of<std::uint8_t>({3, 1, 1}, [](Vec3d p) { return p.x < 1 ? 0 : p.x < 2 ? 128 : 255; });
  EXPECT_NEAR(bounds_of(*isosurface(steps, {127.5})).size().x, 2 + 0.5 - 127.5 / 128 + 0.0, 1e-6);
  EXPECT_NEAR(bounds_of(*isosurface(steps, {128})).min.x, 1.5, 1e-6);
  EXPECT_EQ(isosurface(steps, {255}).error().code, ErrorCode::empty);
  EXPECT_EQ(isosurface(steps, {1e9}).error().code, ErrorCode::empty);
  EXPECT_EQ(bounds_of(*isosurface(steps, {-1})).size().x, 3);
}

TEST(Isosurface, values_that_are_not_finite) {
  auto volume = volume_of<float>({8, 8, 8}, [](Vec3d p) { return p.x < 4 ? 1.0 : 0.0; });
  for (std::size_t i = 0; i < volume.values.size(); i += 7) volume.values[i] = std::numeric_limits<float>::quiet_NaN();
  for (std::size_t i = 3; i < volume.values.size(); i += 11) volume.values[i] = std::numeric_limits<float>::infinity();
  const auto mesh = isosurface(volume, {0.5});
  ASSERT_TRUE(mesh);
  for (const Vec3f& p : mesh->positions) EXPECT_TRUE(std::isfinite(p.x + p.y + p.z));
  EXPECT_TRUE(topology_of(*mesh).closed);
}

TEST(Isosurface, an_infinite_value_is_outside_with_and_without_trilinear) {
  for (const std::uint32_t width : {3U, 70U}) {  // by words, and what is left of a row
    ScalarVolume<float> volume = volume_of<float>({width, 3, 3}, [](Vec3d) { return -1; });
    volume.values[volume.index(1, 1, 1)] = std::numeric_limits<float>::infinity();
    for (const bool trilinear : {false, true}) EXPECT_FALSE(isosurface(volume, {0, trilinear}));
  }
}

TEST(Isosurface, what_is_no_volume) {
  ScalarVolume<float> none;
  EXPECT_EQ(isosurface(none, {0}).error().code, ErrorCode::bad_argument);
  auto volume = volume_of<float>({4, 4, 4}, ball);
  EXPECT_EQ(isosurface(volume, {std::numeric_limits<double>::infinity()}).error().code, ErrorCode::bad_argument);
  EXPECT_EQ(isosurface(volume, {100}).error().code, ErrorCode::empty);
  volume.values.pop_back();
  EXPECT_EQ(isosurface(volume, {0}).error().code, ErrorCode::bad_argument);
}

TEST(Isosurface, same_bytes_for_any_thread_count) {
  const auto volume =
      volume_of<float>({40, 33, 70}, [](Vec3d p) { return std::sin(p.x) + std::sin(p.y) + std::sin(p.z); });
  const auto one = isosurface(volume, {0}, Task::root({}, 1)), seven = isosurface(volume, {0}, Task::root({}, 7));
  EXPECT_EQ(one->positions, seven->positions);
  EXPECT_EQ(one->triangles, seven->triangles);
}

}  // namespace
}  // namespace lodestone::voxel
