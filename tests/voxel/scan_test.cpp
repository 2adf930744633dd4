#include "lodestone/voxel/scan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "lodestone/base/random.h"
#include "lodestone/core/topology.h"
#include "lodestone/voxel/isosurface.h"
#include "lodestone/voxel/resample.h"

namespace lodestone::voxel {
namespace {

Vec3d random_direction(std::uint64_t seed, std::uint64_t& counter) {
  while (true) {
    const Vec3d p{random_unit(seed, counter) * 2 - 1, random_unit(seed, counter + 1) * 2 - 1,
                  random_unit(seed, counter + 2) * 2 - 1};
    counter += 3;
    if (length_sq(p) <= 1 && length_sq(p) > 0.01) return normalized(p);
  }
}

// On the unit sphere, evenly at random, without those above `top`.
PointCloud sphere(std::size_t n, double top = 2, Vec3d offset = {}) {
  PointCloud cloud;
  cloud.offset = offset;
  std::uint64_t counter = 0;
  while (cloud.size() < n) {
    const Vec3d p = random_direction(5, counter);
    if (p.z > top) continue;
    cloud.positions.push_back(to_float(p));
    cloud.normals.push_back(to_float(p));
  }
  return cloud;
}

// Radii 1 and 0.4, z upright.
PointCloud torus(std::size_t n) {
  PointCloud cloud;
  std::uint64_t counter = 0;
  while (cloud.size() < n) {
    const Vec3d p{random_unit(6, counter) * 3 - 1.5, random_unit(6, counter + 1) * 3 - 1.5,
                  random_unit(6, counter + 2) - 0.5};
    counter += 3;
    const double ring = std::sqrt(p.x * p.x + p.y * p.y);
    const Vec3d middle{p.x / ring, p.y / ring, 0};
    const Vec3d out = normalized(p - middle);
    cloud.positions.push_back(to_float(middle + out * 0.4));
    cloud.normals.push_back(to_float(out));
  }
  return cloud;
}

Mesh surface_of(const ScanSolid& scan) {
  ScalarVolume<std::uint8_t> shares = *downsample(scan.volume, scan.volume.grid.size);
  return *isosurface(shares, {127.5});
}
Mesh surface_of(const ScanDistance& scan) { return *isosurface(scan.volume, {0}); }

ScanOptions at(std::uint32_t resolution, double close_radius = 0) {
  ScanOptions options;
  options.resolution = resolution;
  options.close_radius = close_radius;
  return options;
}

struct Off {
  double most = 0, mean = 0;
};
Off off_unit_sphere(const Mesh& mesh, Vec3d center = {}) {
  Off out;
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    const double off = std::abs(length(mesh.position(v) - center) - 1);
    out.most = std::max(out.most, off);
    out.mean += off / static_cast<double>(mesh.vertex_count());
  }
  return out;
}

void expect_closed(const Mesh& mesh, std::int64_t genus) {
  const Topology t = topology_of(mesh);
  EXPECT_TRUE(t.closed && t.manifold);
  EXPECT_EQ(t.components, 1U);
  EXPECT_EQ(t.inconsistent_edges, 0U);
  const auto euler = static_cast<std::int64_t>(t.vertices + t.triangles) - static_cast<std::int64_t>(t.edges);
  EXPECT_EQ(euler, 2 - 2 * genus);
  EXPECT_GT(volume_of(mesh), 0.0);
}

TEST(ScanSolid, of_a_sphere_lies_within_a_voxel_of_it) {
  const auto scan = scan_solid(sphere(60000), at(96));
  ASSERT_TRUE(scan);
  EXPECT_FALSE(scan->figures.open);
  const Mesh mesh = surface_of(*scan);
  expect_closed(mesh, 0);
  EXPECT_LT(off_unit_sphere(mesh).most, scan->volume.grid.spacing.x * std::sqrt(3.0));
  EXPECT_LT(off_unit_sphere(mesh).mean, scan->volume.grid.spacing.x);
}

TEST(ScanDistance, of_a_sphere_lies_within_a_fraction_of_a_voxel) {
  for (const std::size_t points : {2000U, 60000U}) {
    const auto scan = scan_distance(sphere(points), at(96));
    ASSERT_TRUE(scan);
    EXPECT_FALSE(scan->figures.open);
    const Mesh mesh = surface_of(*scan);
    expect_closed(mesh, 0);
    EXPECT_LT(off_unit_sphere(mesh).most, scan->volume.grid.spacing.x * 0.6);
    EXPECT_LT(off_unit_sphere(mesh).mean, scan->volume.grid.spacing.x * 0.2);
  }
}

TEST(ScanDistance, far_from_the_origin) {
  const Vec3d offset{500000, 4000000, 100};
  const auto scan = scan_distance(sphere(20000, 2, offset), at(64));
  ASSERT_TRUE(scan);
  const Mesh mesh = surface_of(*scan);
  expect_closed(mesh, 0);
  EXPECT_LT(off_unit_sphere(mesh, offset).most, scan->volume.grid.spacing.x * 0.5);
}

TEST(Scan, of_a_torus_keeps_its_hole) {
  const PointCloud cloud = torus(60000);
  const auto solid = scan_solid(cloud, at(96));
  const auto distance = scan_distance(cloud, at(96));
  ASSERT_TRUE(solid && distance);
  EXPECT_FALSE(solid->figures.open || distance->figures.open);
  expect_closed(surface_of(*solid), 1);
  expect_closed(surface_of(*distance), 1);
}

// A hole of radius sqrt(1 - 0.95^2) = 0.31 in a sphere.
TEST(Scan, closes_holes_up_to_the_radius_and_tells_larger_ones) {
  const PointCloud cloud = sphere(60000, 0.95);
  const double volume = 4.0 / 3 * 3.14159265;
  {
    const auto solid = scan_solid(cloud, at(96, 0.33));
    const auto distance = scan_distance(cloud, at(96, 0.33));
    ASSERT_TRUE(solid && distance);
    EXPECT_FALSE(solid->figures.open);
    EXPECT_FALSE(distance->figures.open) << distance->figures.open_voxels << " of " << distance->figures.surface_voxels;
    expect_closed(surface_of(*solid), 0);
    expect_closed(surface_of(*distance), 0);
    EXPECT_NEAR(volume_of(surface_of(*solid)), volume, 0.1 * volume);
    EXPECT_NEAR(volume_of(surface_of(*distance)), volume, 0.02 * volume);
  }
  {
    const auto solid = scan_solid(cloud, at(96, 0.15));
    const auto distance = scan_distance(cloud, at(96, 0.15));
    ASSERT_TRUE(solid && distance);
    EXPECT_TRUE(solid->figures.open);
    EXPECT_TRUE(distance->figures.open) << distance->figures.open_voxels << " of " << distance->figures.surface_voxels;
    EXPECT_EQ(solid->figures.warnings.size(), 1U);
    EXPECT_EQ(distance->figures.warnings.size(), 1U);
    expect_closed(surface_of(*distance), 0);  // a shell
    EXPECT_TRUE(topology_of(surface_of(*solid)).closed);
  }
}

TEST(Scan, sparse_points_are_joined_without_being_asked) {
  const PointCloud cloud = sphere(600);
  const auto solid = scan_solid(cloud, at(128));
  const auto distance = scan_distance(cloud, at(128));
  ASSERT_TRUE(solid && distance);
  expect_closed(surface_of(*solid), 0);
  expect_closed(surface_of(*distance), 0);
  EXPECT_LT(off_unit_sphere(surface_of(*distance)).most, 0.05);
  EXPECT_FALSE(distance->figures.warnings.empty()) << "voxels finer than the points";
}

TEST(Scan, of_one_side_is_trimmed_to_the_points) {
  for (const std::size_t points : {3000U, 60000U}) {
    const PointCloud cloud = sphere(points, 0, {100, 0, 0});  // the lower half
    const auto scan = scan_distance(cloud, at(96));
    ASSERT_TRUE(scan);
    EXPECT_TRUE(scan->figures.open);
    const auto sheet = trim_to_points(surface_of(*scan), cloud, scan->figures.sheet_distance);
    ASSERT_TRUE(sheet);
    const Topology t = topology_of(*sheet);
    EXPECT_TRUE(t.manifold);
    EXPECT_FALSE(t.closed);
    EXPECT_NEAR(area_of(*sheet), 2 * 3.14159265, 0.6);
    double most = 0;  // behind the border planes go on straight
    for (std::uint32_t v = 0; v < sheet->vertex_count(); ++v) {
      const Vec3d p = sheet->position(v) - Vec3d{100, 0, 0};
      if (p.z < -0.1) most = std::max(most, std::abs(length(p) - 1));
    }
    EXPECT_LT(most, scan->volume.grid.spacing.x);
  }
  EXPECT_EQ(trim_to_points(Mesh{}, sphere(10), 1).error().code, ErrorCode::empty);
}

TEST(ScanSolid, splats_make_it_larger) {
  ScanOptions options = at(96);
  const auto plain = scan_solid(sphere(60000), options);
  options.splat_radius = 2;
  const auto larger = scan_solid(sphere(60000), options);
  ASSERT_TRUE(plain && larger);
  const double side = larger->volume.grid.spacing.x;
  const Mesh mesh = surface_of(*larger);
  expect_closed(mesh, 0);
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v)
    EXPECT_NEAR(length(mesh.position(v)), 1 + 2.5 * side, 1.5 * side);
}

TEST(Scan, unknown_normals_only_tell_where_the_surface_is) {
  PointCloud cloud = sphere(60000);
  for (std::size_t i = 0; i < cloud.size(); i += 3) cloud.normals[i] = {};
  const auto scan = scan_distance(cloud, at(64));
  ASSERT_TRUE(scan);
  expect_closed(surface_of(*scan), 0);
  std::fill(cloud.normals.begin(), cloud.normals.end(), Vec3f{});
  ASSERT_TRUE(scan_distance(cloud, at(64)));
}

TEST(Scan, odd_clouds_end) {
  PointCloud cloud;
  cloud.positions = {{0, 0, 0}, {1, 0, 0}};
  cloud.normals.assign(2, {0, 0, 1});
  EXPECT_TRUE(scan_solid(cloud, at(64)));
  EXPECT_TRUE(scan_distance(cloud, at(64)));
  cloud.positions = {{0, 0, 0}, {1e30F, 0, 0}, {1e30F, 1e30F, 2}};
  cloud.normals.assign(3, {0, 0, 1});
  EXPECT_TRUE(scan_solid(cloud, at(64)));
  EXPECT_TRUE(scan_distance(cloud, at(64)));
  cloud = sphere(1000);
  for (std::size_t i = 500; i < 1000; ++i) cloud.positions[i].x += 1e6F;  // clusters far apart
  EXPECT_TRUE(scan_solid(cloud, at(64)));
  EXPECT_TRUE(scan_distance(cloud, at(64)));
  cloud.positions.assign(1000, Vec3f{1, 1, 1});
  EXPECT_EQ(scan_solid(cloud).error().code, ErrorCode::bad_argument);
}

TEST(Scan, what_makes_no_sense_is_told) {
  PointCloud cloud = sphere(1000);
  EXPECT_EQ(scan_solid(PointCloud{}).error().code, ErrorCode::empty);
  EXPECT_EQ(scan_solid(cloud, at(3)).error().code, ErrorCode::bad_argument);
  EXPECT_EQ(scan_solid(cloud, at(64, 1)).error().code, ErrorCode::bad_argument);
  EXPECT_EQ(scan_solid(cloud, at(64, -1)).error().code, ErrorCode::bad_argument);
  EXPECT_EQ(scan_solid(cloud, at(64, NAN)).error().code, ErrorCode::bad_argument);
  EXPECT_EQ(scan_solid(cloud, at(4000, 0.5)).error().code, ErrorCode::bad_argument);
  for (const auto& result : {scan_solid(cloud, at(2048)).error()}) {
    EXPECT_EQ(result.code, ErrorCode::out_of_memory);
    EXPECT_NE(result.line().find("GB"), std::string::npos) << result.line();
  }
  ScanOptions options = at(64);
  options.most_bytes = 100000;
  EXPECT_EQ(scan_distance(cloud, options).error().code, ErrorCode::out_of_memory);
  cloud.normals.clear();
  EXPECT_EQ(scan_distance(cloud).error().code, ErrorCode::bad_argument);
  cloud.positions[3].y = INFINITY;
  EXPECT_EQ(scan_solid(cloud).error().code, ErrorCode::bad_argument);
}

TEST(Scan, same_bytes_for_any_thread_count) {
  const PointCloud cloud = torus(20000);
  const auto solid = scan_solid(cloud, at(80), Task::root({}, 1));
  const auto distance = scan_distance(cloud, at(80), Task::root({}, 1));
  for (const int threads : {2, 7}) {
    EXPECT_EQ(scan_solid(cloud, at(80), Task::root({}, threads))->volume.words, solid->volume.words);
    const auto other = scan_distance(cloud, at(80), Task::root({}, threads));
    EXPECT_EQ(other->volume.values, distance->volume.values);
    EXPECT_EQ(other->figures.open_voxels, distance->figures.open_voxels);
  }
}

TEST(Scan, cancelled_gives_no_half_result) {
  const Task task = Task::root({}, 1);
  task.cancel();
  EXPECT_EQ(scan_solid(sphere(1000), at(64), task).error().code, ErrorCode::cancelled);
  EXPECT_EQ(scan_distance(sphere(1000), at(64), task).error().code, ErrorCode::cancelled);
}

}  // namespace
}  // namespace lodestone::voxel
