#include "lodestone/simplify/prune/thin_parts.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "lodestone/base/random.h"
#include "lodestone/math/triangle.h"
#include "support/shapes.h"

namespace lodestone::simplify {
namespace {

ThinParts order_of(const Mesh& mesh, const ThinPartsOptions& options = {}) {
  Result<ThinParts> r = thin_parts(mesh, options);
  EXPECT_TRUE(r);
  return std::move(*r);
}

// Single triangles at random places in the unit cube: all that can happen to them is to vanish.
Mesh crumbs(int count) {
  Mesh mesh;
  std::uint64_t counter = 0;
  const auto random = [&] { return static_cast<float>(random_unit(3, counter++)); };
  for (int i = 0; i < count; ++i) {
    const Vec3f at{random(), random(), random()};
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int k = 0; k < 3; ++k) mesh.positions.push_back(at + Vec3f{random(), random(), random()} * 0.02F);
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

bool equal(const ThinParts& a, const ThinParts& b) {
  return std::equal(a.vanishings.begin(), a.vanishings.end(), b.vanishings.begin(), b.vanishings.end(),
                    [](const Vanishing& x, const Vanishing& y) {
                      return x.part == y.part && x.absorber == y.absorber && x.error == y.error;
                    });
}

TEST(ThinParts, all_but_one_vanish_once_and_errors_never_fall) {
  for (const bool keep_area : {false, true}) {
    ThinPartsOptions options;
    options.keep_area = keep_area;
    const ThinParts thin = order_of(test::canopy(300), options);
    EXPECT_EQ(thin.parts.count, 301U);
    ASSERT_EQ(thin.vanishings.size(), 300U);
    std::vector<bool> gone(301, false);
    float error = 0;
    for (const Vanishing& v : thin.vanishings) {
      EXPECT_FALSE(gone[v.part]);
      EXPECT_FALSE(gone[v.absorber]) << "who takes over is still there";
      EXPECT_NE(v.part, v.absorber);
      EXPECT_GE(v.error, error);
      error = v.error;
      gone[v.part] = true;
    }
    EXPECT_FALSE(gone[0]) << "the trunk is what errs most";
  }
}

TEST(ThinParts, an_error_is_not_less_than_what_is_lost) {
  const Mesh mesh = crumbs(120);
  const ThinParts thin = order_of(mesh);
  std::vector<bool> gone(120, false);
  double most_over = 0;
  for (const Vanishing& v : thin.vanishings) {
    gone[v.part] = true;
    double lost = 0;  // of all vertices of vanished parts, the farthest from what is left
    for (std::uint32_t p = 0; p < mesh.vertex_count(); ++p) {
      if (!gone[thin.parts.of_vertex[p]]) continue;
      double near = 1e30;
      for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (gone[thin.parts.of_triangle(mesh, t)]) continue;
        const Triangle c = mesh.vertices_of(t);
        near = std::min(near, closest_point(to_double(mesh.positions[p]), to_double(mesh.positions[c[0]]),
                                            to_double(mesh.positions[c[1]]), to_double(mesh.positions[c[2]]))
                                  .distance_sq);
      }
      lost = std::max(lost, std::sqrt(near));
    }
    EXPECT_LE(lost, v.error * 1.0001);
    most_over = std::max(most_over, v.error / lost);
  }
  EXPECT_LT(most_over, 6) << "and not without bounds above it";
}

TEST(ThinParts, lengths_are_those_of_the_metric) {
  ThinPartsOptions options;
  const ThinParts plain = order_of(crumbs(40), options);
  options.metric = Mat4d::scale({10, 10, 10});
  const ThinParts large = order_of(crumbs(40), options);
  ASSERT_EQ(plain.vanishings.size(), large.vanishings.size());
  for (std::size_t i = 0; i < plain.vanishings.size(); ++i) {
    EXPECT_NEAR(large.vanishings[i].error, 10 * plain.vanishings[i].error, 1e-5 * large.vanishings[i].error);
  }
  EXPECT_NEAR(large.area[5], 100 * plain.area[5], 1e-9);
}

TEST(ThinParts, what_holds_a_locked_vertex_stays_and_what_matters_stays_longer) {
  const Mesh mesh = crumbs(50);
  ThinPartsOptions options;
  options.locked.assign(mesh.vertex_count(), 0);
  options.locked[3 * 7] = options.locked[3 * 30] = 1;
  const ThinParts locked = order_of(mesh, options);
  EXPECT_EQ(locked.vanishings.size(), 48U);
  for (const Vanishing& v : locked.vanishings) EXPECT_TRUE(v.part != 7 && v.part != 30);
  options.locked.clear();
  options.weights.assign(mesh.vertex_count(), 1);
  options.weights[3 * 7] = 1e6F;
  EXPECT_EQ(order_of(mesh, options).vanishings.size(), 49U);
  for (const Vanishing& v : order_of(mesh, options).vanishings) EXPECT_NE(v.part, 7U);
  options.weights.resize(2);
  EXPECT_EQ(thin_parts(mesh, options).error().code, ErrorCode::bad_argument);
}

TEST(ThinParts, the_same_for_any_number_of_threads) {
  ThinPartsOptions options;
  options.keep_area = true;
  const Mesh mesh = test::canopy(400);
  const ThinParts one = *thin_parts(mesh, options, Task::root({}, 1));
  EXPECT_TRUE(equal(one, *thin_parts(mesh, options, Task::root({}, 2))));
  EXPECT_TRUE(equal(one, *thin_parts(mesh, options, Task::root({}, 7))));
  const Task task = Task::root({});
  task.cancel();
  EXPECT_EQ(thin_parts(mesh, options, task).error().code, ErrorCode::cancelled);
}

TEST(ThinParts, can_be_cancelled_at_any_moment) {
  Mesh mesh;  // parts of more vertices than are asked at once
  const Mesh torus = test::torus(9);
  for (std::uint64_t i = 0; i < 1500; ++i) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const Vec3f at{static_cast<float>(random_unit(1, 3 * i)), static_cast<float>(random_unit(1, 3 * i + 1)),
                   static_cast<float>(random_unit(1, 3 * i + 2))};
    for (const Vec3f p : torus.positions) mesh.positions.push_back(p + at * 200.0F);
    for (const Triangle& t : torus.triangles) mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  for (const double when : {0.05, 0.3, 0.7}) {
    const Task* running = nullptr;
    const Task task = Task::root([&](double done, const std::string&) {
      if (done > when) running->cancel();
    });
    running = &task;
    const Result<ThinParts> out = thin_parts(mesh, {}, task);
    ASSERT_FALSE(out);
    EXPECT_EQ(out.error().code, ErrorCode::cancelled);
  }
}

TEST(ThinParts, odd_meshes_are_no_trouble) {
  for (const test::Shape& shape : test::small_shapes()) {
    const ThinParts thin = order_of(shape.make());
    EXPECT_LT(thin.vanishings.size(), std::max<std::size_t>(1, thin.parts.count)) << shape.name;
  }
  EXPECT_TRUE(order_of(Mesh{}).vanishings.empty());
  // Parts without area, and one of which nothing takes part.
  Mesh mesh = crumbs(3);
  mesh.positions[1] = mesh.positions[2] = mesh.positions[0];
  ThinPartsOptions options;
  options.keep_area = true;
  EXPECT_EQ(order_of(mesh, options).vanishings.size(), 2U);
  options.left_out = {0, 1};
  EXPECT_TRUE(order_of(mesh, options).vanishings.empty());
}

}  // namespace
}  // namespace lodestone::simplify
