#include "lodestone/spatial/bvh.h"

#include <gtest/gtest.h>

#include "lodestone/base/random.h"
#include "lodestone/math/triangle.h"
#include "support/shapes.h"

namespace lodestone::spatial {
namespace {

double brute_distance_sq(const Surface& surface, Vec3d p) {
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto [a, b, c] = surface.corners(t);
    best = std::min(best, closest_point(p, a, b, c).distance_sq);
  }
  return best;
}

void expect_exact(const Mesh& mesh, double spread) {
  const auto surface = flatten(make_model(mesh));
  ASSERT_TRUE(surface);
  const Bvh tree(*surface);
  const Vec3d center = surface->bounds.center();
  const double size = surface->bounds.diagonal() * spread;
  for (std::uint64_t i = 0; i < 200; ++i) {
    const Vec3d p =
        center +
        Vec3d{random_unit(7, 3 * i) - 0.5, random_unit(7, 3 * i + 1) - 0.5, random_unit(7, 3 * i + 2) - 0.5} * size;
    const double brute = brute_distance_sq(*surface, p);
    EXPECT_EQ(tree.closest(p).distance_sq, brute);
    const auto hint = static_cast<std::uint32_t>(random_bits(8, i) % surface->triangles.size());
    EXPECT_EQ(tree.closest(p, hint).distance_sq, brute);
  }
}

TEST(Bvh, answers_as_all_triangles_would) {
  for (const test::Shape& shape : test::small_shapes()) {
    SCOPED_TRACE(shape.name);
    expect_exact(shape.make(), 1.5);
    expect_exact(shape.make(), 1000);
  }
}

// Long thin triangles across a square, whose boxes alone would all overlap.
Mesh slivers(std::uint32_t count) {
  Mesh mesh;
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto at = static_cast<float>(i) / static_cast<float>(count);
    const float wide = 0.1F / static_cast<float>(count);
    mesh.positions.insert(mesh.positions.end(), {{at, 0, 0}, {at + wide, 0, 0.01F}, {1 + at, 1, 0.3F * at}});
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

TEST(Bvh, thin_triangles_are_found_once_each) {
  for (const std::uint32_t count : {1U, 7U, 500U}) {
    SCOPED_TRACE(count);
    const Mesh mesh = slivers(count);
    expect_exact(mesh, 1.5);
    const auto surface = flatten(make_model(mesh));
    ASSERT_TRUE(surface);
    const Bvh tree(*surface);
    std::vector<Nearest> found;
    tree.all_within({0.5, 0.5, 0.1}, 10, found);
    EXPECT_EQ(found.size(), count);
    std::vector<std::uint32_t> inside;
    ASSERT_TRUE(tree.triangles_in(surface->bounds, 100'000, inside));
    EXPECT_EQ(inside.size(), count);
  }
}

TEST(Bvh, thin_triangles_have_near_neighbours_only) {
  const auto surface = flatten(make_model(slivers(2000)));
  ASSERT_TRUE(surface);
  const Bvh tree(*surface);
  std::vector<std::uint32_t> inside;
  const Vec3d at{0.9, 0.5, 0.1}, near{0.005, 0.005, 0.005};
  ASSERT_TRUE(tree.triangles_in({at - near, at + near}, 100'000, inside));
  EXPECT_LT(inside.size(), 200U) << "boxes of whole triangles: over half of them";
}

TEST(Bvh, sizes_do_not_matter) {
  for (const float scale : {1e-30F, 1e-6F, 1e6F, 1e30F}) {
    Mesh mesh = test::torus(10);
    for (Vec3f& p : mesh.positions) p *= scale;
    SCOPED_TRACE(scale);
    expect_exact(mesh, 1.5);
  }
}

TEST(Bvh, all_within_finds_what_all_triangles_would) {
  for (const test::Shape& shape : test::small_shapes()) {
    SCOPED_TRACE(shape.name);
    const auto surface = flatten(make_model(shape.make()));
    ASSERT_TRUE(surface);
    const Bvh tree(*surface);
    for (std::uint64_t i = 0; i < 50; ++i) {
      const Vec3d p = surface->bounds.center() + Vec3d{random_unit(3, 3 * i) - 0.5, random_unit(3, 3 * i + 1) - 0.5,
                                                       random_unit(3, 3 * i + 2) - 0.5} *
                                                     surface->bounds.diagonal();
      const double within = surface->bounds.diagonal() * random_unit(4, i) * 0.5;
      std::vector<Nearest> found;
      tree.all_within(p, within, found);
      std::size_t expected = 0;
      double facing = within * within;
      bool any = false;
      for (std::size_t t = 0; t < surface->triangles.size(); ++t) {
        const auto [a, b, c] = surface->corners(t);
        const double d = closest_point(p, a, b, c).distance_sq;
        expected += d <= within * within ? 1 : 0;
        if (d <= facing && scaled_normal(a, b, c).z > 0) {
          facing = d;
          any = true;
        }
      }
      EXPECT_EQ(found.size(), expected);
      const Nearest up = tree.closest_facing(p, {0, 0, 1}, within);
      EXPECT_EQ(up.triangle != kNone, any);
      if (any) {
        EXPECT_EQ(up.distance_sq, facing);
      }
    }
  }
}

TEST(Surface, instances_and_mirrors) {
  Model model = make_model(test::cube());
  model.instances.push_back({0, Mat4d::translation({5, 0, 0}) * Mat4d::scale({-1, 1, 1}), "mirrored"});
  const auto surface = flatten(model);
  ASSERT_TRUE(surface);
  EXPECT_EQ(surface->triangles.size(), 24U);
  double volume = 0;
  for (std::size_t t = 0; t < 24; ++t) {
    const auto [a, b, c] = surface->corners(t);
    volume += dot(a, cross(b, c)) / 6;
  }
  EXPECT_NEAR(volume, 2, 1e-12);  // both outward
  EXPECT_FALSE(flatten(Model{}));
}

}  // namespace
}  // namespace lodestone::spatial
