#include "lodestone/chain/voxels/volume_surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "lodestone/core/topology.h"
#include "lodestone/voxel/otsu.h"

namespace lodestone::chain {
namespace {

VolumeSurfaceOptions at_iso(double iso) {
  VolumeSurfaceOptions options;
  options.iso = iso;
  return options;
}

VolumeSurfaceOptions labels_with(double smooth) {
  VolumeSurfaceOptions options;
  options.labels = true;
  options.smooth = smooth;
  return options;
}

Model made_evenly(ScannedVolume volume) {
  volume.header.slice_positions.clear();
  auto made = surface_of(volume, labels_with(0));
  return made ? std::move(made->model) : Model();
}

// A ball of radius r voxels around the middle: values fall off from 100 at its centre, 0 at its border, below beyond.
struct Ball {
  ScannedVolume volume;
  std::vector<float> values;

  explicit Ball(std::uint32_t n, double r) {
    VoxelGrid& grid = volume.header.grid;
    grid = {{n, n, n}, {-0.5, -0.5, -0.5}, {1, 1, 1}};
    const double middle = (n - 1) / 2.0;
    for (std::uint32_t z = 0; z < n; ++z) {
      for (std::uint32_t y = 0; y < n; ++y) {
        for (std::uint32_t x = 0; x < n; ++x) {
          const Vec3d d{x - middle, y - middle, z - middle};
          values.push_back(static_cast<float>(100 - 100 * length(d) / r));
        }
      }
    }
    volume.values = std::span<const float>(values);
  }
};

TEST(VolumeSurface, lies_where_the_file_says) {
  Ball ball(24, 8);
  VolumeHeader& header = ball.volume.header;
  header.patient_axes = true;
  header.meters_per_unit = 0.001;
  // Mirrored along x, sheared, and moved.
  header.to_world.m = {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0.5, 1, 0, 100, 200, 300, 1};
  const auto made = surface_of(ball.volume, at_iso(0));
  ASSERT_TRUE(made) << made.error().what;
  const Mesh& mesh = made->model.meshes.front();
  const Topology t = topology_of(mesh);
  EXPECT_TRUE(t.closed && t.manifold);
  EXPECT_GT(volume_of(mesh), 0) << "faces look outward though the frame is mirrored";
  EXPECT_NEAR(volume_of(mesh), 4.0 / 3 * 3.14159265 * 512, 25);
  const Vec3d middle = bounds_of(mesh).center();
  EXPECT_NEAR(middle.x, 100 - 11.5, 0.1);
  EXPECT_NEAR(middle.y, 200 + 11.5 + 0.5 * 11.5, 0.1);
  EXPECT_NEAR(middle.z, 300 + 11.5, 0.1);
  EXPECT_EQ(made->model.meters_per_unit, 0.001);
  // What is above in a patient is above in glTF, and what is in front is in front.
  EXPECT_EQ(made->model.gltf_axes.direction({0, 0, 1}), (Vec3d{0, 1, 0}));
  EXPECT_EQ(made->model.gltf_axes.direction({0, -1, 0}), (Vec3d{0, 0, 1}));
}

TEST(VolumeSurface, keeps_uneven_slices_apart) {
  Ball ball(24, 8);
  std::vector<double>& places = ball.volume.header.slice_positions;
  for (int z = 0; z < 24; ++z) places.push_back(z < 12 ? z : 12 + 2 * (z - 12));
  const auto made = surface_of(ball.volume, at_iso(0));
  ASSERT_TRUE(made);
  const Box3d box = bounds_of(made->model.meshes.front());
  EXPECT_NEAR(box.min.z, 3.5, 0.1);
  EXPECT_NEAR(box.max.z, 12 + 2 * 7.5, 0.2);
}

TEST(VolumeSurface, refuses_what_has_no_surface) {
  Ball ball(8, 3);
  const auto outside = surface_of(ball.volume, at_iso(1000));
  ASSERT_FALSE(outside);
  EXPECT_EQ(outside.error().code, ErrorCode::bad_argument);
  EXPECT_NE(outside.error().what.find("to 71"), std::string::npos) << outside.error().what;
  for (float& v : ball.values) v = 5;
  EXPECT_EQ(surface_of(ball.volume).error().code, ErrorCode::empty);
  for (float& v : ball.values) v = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(surface_of(ball.volume).error().code, ErrorCode::bad_format);
}

TEST(VolumeSurface, takes_otsus_threshold) {
  std::vector<std::uint8_t> values;
  for (int i = 0; i < 1000; ++i) values.push_back(static_cast<std::uint8_t>(i % 2 == 0 ? 20 + i % 7 : 180 + i % 9));
  const double iso = voxel::otsu_threshold(std::span<const std::uint8_t>(values), 20, 188);
  EXPECT_GT(iso, 26);
  EXPECT_LT(iso, 180);
}

TEST(VolumeSurface, makes_a_mesh_for_each_label) {
  std::vector<std::int16_t> labels(10 * 10 * 10, 0);
  const auto set = [&](std::uint32_t x, std::uint32_t y, std::uint32_t z, std::int16_t l) {
    labels[(z * 10 + y) * 10 + x] = l;
  };
  for (std::uint32_t z = 2; z < 6; ++z) {
    for (std::uint32_t y = 2; y < 6; ++y) {
      for (std::uint32_t x = 1; x < 9; ++x) set(x, y, z, x < 5 ? 3 : -7);
    }
  }
  ScannedVolume volume;
  volume.header.grid = {{10, 10, 10}, {-0.5, -0.5, -0.5}, {1, 1, 1}};
  volume.values = std::span<const std::int16_t>(labels);
  for (const double smooth : {0.0, 0.6}) {
    const auto made = surface_of(volume, labels_with(smooth));
    ASSERT_TRUE(made) << made.error().what;
    ASSERT_EQ(made->model.meshes.size(), 2U);
    EXPECT_EQ(made->model.meshes[0].name, "label -7");
    EXPECT_EQ(made->model.meshes[1].name, "label 3");
    for (const Mesh& mesh : made->model.meshes) {
      const Topology t = topology_of(mesh);
      EXPECT_TRUE(t.closed && t.manifold);
      EXPECT_NEAR(volume_of(mesh), 64, 20);
    }
    EXPECT_LT(bounds_of(made->model.meshes[1]).max.x, bounds_of(made->model.meshes[0]).max.x);
  }
  // Slices 1 apart up to the middle of the cubes, 3 apart beyond it.
  for (int z = 0; z < 10; ++z) volume.header.slice_positions.push_back(z < 5 ? z : 5 + 3 * (z - 5));
  const auto uneven = surface_of(volume, labels_with(0));
  ASSERT_TRUE(uneven) << uneven.error().what;
  for (const Mesh& mesh : uneven->model.meshes) {
    const Box3d even_box = bounds_of(made_evenly(volume).meshes.front()), box = bounds_of(mesh);
    EXPECT_NEAR(box.size().z, even_box.size().z + 1, 1e-5) << "the far slices are thicker";
  }
  volume.header.slice_positions.clear();
  std::vector<float> broken(1000, 0.5F);
  volume.values = std::span<const float>(broken);
  EXPECT_FALSE(surface_of(volume, labels_with(0)));
}

TEST(VolumeSurface, takes_no_grey_values_for_labels) {
  constexpr std::uint32_t kSide = 24;
  std::vector<std::int16_t> values(kSide * kSide * kSide);
  ScannedVolume volume;
  volume.header.grid = {{kSide, kSide, kSide}, {-0.5, -0.5, -0.5}, {1, 1, 1}};
  volume.values = std::span<const std::int16_t>(values);
  const auto fill = [&](const auto& value) {
    std::size_t i = 0;
    for (int z = 0; z < static_cast<int>(kSide); ++z) {
      for (int y = 0; y < static_cast<int>(kSide); ++y) {
        for (int x = 0; x < static_cast<int>(kSide); ++x) values[i++] = static_cast<std::int16_t>(value(x, y, z));
      }
    }
  };
  fill([](int x, int y, int z) { return 1 + 3 * x + 2 * y + z; });
  const auto grey = surface_of(volume, labels_with(0));
  ASSERT_FALSE(grey);
  EXPECT_EQ(grey.error().code, ErrorCode::bad_argument);
  EXPECT_NE(grey.error().line().find("grey values, not labels; leave `labels` out"), std::string::npos);
  // As many labels in cubes of four voxels, in order; and single voxels whose numbers say nothing.
  fill([](int x, int y, int z) { return 1 + x / 4 + 6 * (y / 4) + 36 * (z / 4); });
  const auto cubes = surface_of(volume, labels_with(0));
  ASSERT_TRUE(cubes) << cubes.error().line();
  EXPECT_EQ(cubes->model.meshes.size(), 216U);
  fill([](int x, int y, int z) { return 1 + (x * 37 + y * 101 + z * 59) % 64; });
  EXPECT_TRUE(surface_of(volume, labels_with(0)));
}

}  // namespace
}  // namespace lodestone::chain
