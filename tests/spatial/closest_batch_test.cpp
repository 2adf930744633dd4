#include "lodestone/spatial/closest_batch.h"

#include <gtest/gtest.h>

#include "lodestone/base/random.h"
#include "lodestone/math/triangle.h"
#include "support/shapes.h"

namespace lodestone::spatial {
namespace {

std::vector<Vec3d> points_around(const Box3d& box, double share, std::size_t count, std::uint64_t seed) {
  std::vector<Vec3d> points;
  const double extent = box.diagonal() * share;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3d u{random_unit(seed, 3 * i), random_unit(seed, 3 * i + 1), random_unit(seed, 3 * i + 2)};
    points.push_back(box.center() + (u - Vec3d{0.5, 0.5, 0.5}) * extent);
  }
  return points;
}

void same_as_one_by_one(const Surface& surface, const std::vector<Vec3d>& points, const std::string& name) {
  const Bvh tree(surface);
  std::vector<Nearest> found(points.size());
  ClosestBatch(tree).find(points, found);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Nearest one = tree.closest(points[i]);
    ASSERT_EQ(found[i].distance_sq, one.distance_sq) << name << " " << i;
    ASSERT_NE(found[i].triangle, kNone) << name;
  }
}

TEST(ClosestBatch, answers_as_one_by_one) {
  for (const test::Shape& shape : test::small_shapes()) {
    const auto surface = flatten(make_model(shape.make()));
    if (!surface) continue;
    for (const double share : {1.2, 0.1, 1e-4, 0.0, 30.0}) {
      same_as_one_by_one(*surface, points_around(surface->bounds, share, 203, 5), shape.name);
    }
  }
}

TEST(ClosestBatch, points_on_and_near_a_fine_surface) {
  const auto surface = flatten(make_model(test::torus(50)));
  for (const double off : {0.0, 1e-9, 1e-4, 0.01}) {
    std::vector<Vec3d> points;
    for (std::size_t t = 0; t < surface->triangles.size(); ++t) {
      const auto [a, b, c] = surface->corners(t);
      points.push_back((a + b + c) / 3.0 + normalized(scaled_normal(a, b, c)) * off);
      points.push_back(a + (b - a) * 0.3);
      points.push_back(c);
    }
    same_as_one_by_one(*surface, points, std::to_string(off));
  }
}

// Slivers, whose planes single precision does not know, and sizes at which its squares leave its range.
TEST(ClosestBatch, slivers_and_sizes) {
  for (const float scale : {1.0F, 1e-15F, 1e-30F, 1e15F, 1e30F}) {
    Mesh mesh;
    for (std::uint32_t i = 0; i < 60; ++i) {
      const auto u = [&](std::uint64_t k) { return static_cast<float>(random_unit(3, 9 * i + k)); };
      const Vec3f a{u(0), u(1), u(2)}, d{u(3), u(4), u(5)};
      mesh.positions.insert(mesh.positions.end(),
                            {a * scale, (a + d) * scale, (a + d * 0.4F + Vec3f{1e-6F, 0, 0}) * scale});
      mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    const auto surface = flatten(make_model(mesh));
    ASSERT_TRUE(surface);
    for (const double share : {1.0, 0.01}) {
      same_as_one_by_one(*surface, points_around(surface->bounds, share, 400, 8), std::to_string(scale));
    }
  }
}

TEST(ClosestBatch, far_from_the_origin) {
  Mesh mesh = test::torus(20);
  mesh.offset = {1e6, -1e6, 1e6};
  const auto surface = flatten(make_model(mesh));
  same_as_one_by_one(*surface, points_around(surface->bounds, 1.1, 1000, 2), "far");
}

}  // namespace
}  // namespace lodestone::spatial
