#include "lodestone/points/normals.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lodestone/base/random.h"
#include "lodestone/core/mesh.h"
#include "support/shapes.h"

namespace lodestone::points {
namespace {

// Evenly at random on a sphere, without its normals.
PointCloud sphere_points(std::size_t n, Vec3f center = {}, float radius = 1, std::uint64_t seed = 1) {
  PointCloud cloud;
  for (std::uint64_t i = 0; cloud.size() < n; ++i) {
    const Vec3d p{random_unit(seed, 3 * i) * 2 - 1, random_unit(seed, 3 * i + 1) * 2 - 1,
                  random_unit(seed, 3 * i + 2) * 2 - 1};
    if (length_sq(p) > 1 || length_sq(p) < 0.01) continue;
    cloud.positions.push_back(center + to_float(normalized(p)) * radius);
  }
  return cloud;
}

void append(PointCloud& cloud, const PointCloud& more) {
  cloud.positions.insert(cloud.positions.end(), more.positions.begin(), more.positions.end());
}

TEST(Normals, of_a_sphere_look_outward) {
  const PointCloud cloud = sphere_points(20000);
  const auto normals = estimate_normals(cloud);
  ASSERT_TRUE(normals);
  EXPECT_EQ(normals->pieces, 1U);
  EXPECT_EQ(normals->unknown, 0U);
  for (std::size_t i = 0; i < cloud.size(); ++i) EXPECT_GT(dot(normals->normals[i], cloud.positions[i]), 0.97F);
}

TEST(Normals, of_pieces_look_outward_each) {
  PointCloud cloud = sphere_points(3000);
  append(cloud, sphere_points(2000, {10, 0, 0}, 0.5F, 2));
  append(cloud, sphere_points(1000, {0, -7, 3}, 2, 3));
  const auto normals = estimate_normals(cloud);
  ASSERT_TRUE(normals);
  EXPECT_EQ(normals->pieces, 3U);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vec3f center = i < 3000 ? Vec3f{} : i < 5000 ? Vec3f{10, 0, 0} : Vec3f{0, -7, 3};
    ASSERT_GT(dot(normals->normals[i], cloud.positions[i] - center), 0.0F) << i;
  }
}

TEST(Normals, of_a_torus_look_outward_inside_its_hole_too) {
  const Mesh torus = test::torus(96);
  PointCloud cloud;
  cloud.positions = torus.positions;
  const auto normals = estimate_normals(cloud);
  ASSERT_TRUE(normals);
  std::vector<Vec3d> expected(torus.positions.size());
  for (std::size_t t = 0; t < torus.triangles.size(); ++t) {
    const auto v = torus.vertices_of(t);
    const Vec3d n = cross(torus.position(v[1]) - torus.position(v[0]), torus.position(v[2]) - torus.position(v[0]));
    for (const std::uint32_t i : v) expected[i] += n;
  }
  for (std::size_t i = 0; i < expected.size(); ++i) {
    ASSERT_GT(dot(to_double(normals->normals[i]), normalized(expected[i])), 0.9) << i;
  }
}

TEST(Normals, given_ones_are_turned_and_else_kept) {
  PointCloud cloud = sphere_points(5000);
  cloud.normals = cloud.positions;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (random_bits(3, i) % 2 == 0) cloud.normals[i] = -cloud.normals[i];
  }
  const auto normals = orient_normals(cloud);
  ASSERT_TRUE(normals);
  EXPECT_EQ(normals->normals, cloud.positions);
}

TEST(Normals, that_look_inward_are_seen) {
  PointCloud cloud = sphere_points(5000);
  EXPECT_EQ(outward_share(cloud), 1.0) << "none are known";
  cloud.normals = cloud.positions;
  EXPECT_EQ(outward_share(cloud), 1.0);
  for (Vec3f& n : cloud.normals) n = -n;
  EXPECT_EQ(outward_share(cloud), 0.0);
}

TEST(Normals, where_there_are_none) {
  PointCloud cloud;
  EXPECT_EQ(estimate_normals(cloud).error().code, ErrorCode::empty);
  cloud.positions.assign(100, Vec3f{1, 1, 1});
  const auto same = estimate_normals(cloud);
  ASSERT_TRUE(same);
  EXPECT_EQ(same->unknown, 100U);
  cloud.positions.assign(1, Vec3f{1, 1, 1});
  ASSERT_TRUE(estimate_normals(cloud));
  cloud.positions = {{0, 0, 0}, {1, 0, 0}};
  ASSERT_TRUE(estimate_normals(cloud));
  EXPECT_EQ(orient_normals(cloud).error().code, ErrorCode::bad_argument);
  EXPECT_EQ(estimate_normals(cloud, {2, 10}).error().code, ErrorCode::bad_argument);
  EXPECT_EQ(estimate_normals(cloud, {16, 100}).error().code, ErrorCode::bad_argument);
  cloud.positions[0].x = NAN;
  EXPECT_EQ(estimate_normals(cloud).error().code, ErrorCode::bad_argument);
}

TEST(Normals, don_t_depend_on_threads_or_size) {
  const PointCloud cloud = sphere_points(30000);
  PointCloud small = cloud;
  for (Vec3f& p : small.positions) p *= 0x1p-80F;
  const auto one = estimate_normals(cloud, {}, Task::root({}, 1));
  ASSERT_TRUE(one);
  for (const int threads : {2, 7}) {
    const auto other = estimate_normals(cloud, {}, Task::root({}, threads));
    ASSERT_TRUE(other);
    EXPECT_EQ(one->normals, other->normals);
  }
  EXPECT_EQ(one->normals, estimate_normals(small)->normals);
}

TEST(Normals, cancelled_gives_no_half_result) {
  const Task task = Task::root({}, 1);
  task.cancel();
  const auto normals = estimate_normals(sphere_points(1000), {}, task);
  ASSERT_FALSE(normals);
  EXPECT_EQ(normals.error().code, ErrorCode::cancelled);
}

}  // namespace
}  // namespace lodestone::points
