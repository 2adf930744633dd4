#include "lodestone/simplify/prune/prune_order.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "lodestone/base/random.h"
#include "lodestone/math/triangle.h"
#include "support/shapes.h"

namespace lodestone::simplify {
namespace {

PruneOrder order_of(const Mesh& mesh, const PruneOptions& options = {}) {
  Result<PruneOrder> r = prune_order(mesh, options);
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

bool equal(const PruneOrder& a, const PruneOrder& b) {
  return std::equal(a.steps.begin(), a.steps.end(), b.steps.begin(), b.steps.end(),
                    [](const PruneStep& x, const PruneStep& y) {
                      return x.part == y.part && x.absorber == y.absorber && x.error == y.error;
                    });
}

TEST(PruneOrder, all_but_one_vanish_once_and_errors_never_fall) {
  for (const bool keep_area : {false, true}) {
    PruneOptions options;
    options.keep_area = keep_area;
    const PruneOrder thin = order_of(test::canopy(300), options);
    EXPECT_EQ(thin.parts.count, 301U);
    ASSERT_EQ(thin.steps.size(), 300U);
    std::vector<bool> gone(301, false);
    float error = 0;
    for (const PruneStep& v : thin.steps) {
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

TEST(PruneOrder, an_error_is_not_less_than_what_is_lost) {
  const Mesh mesh = crumbs(120);
  const PruneOrder thin = order_of(mesh);
  std::vector<bool> gone(120, false);
  double most_over = 0;
  for (const PruneStep& v : thin.steps) {
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

TEST(PruneOrder, lengths_are_those_of_the_metric) {
  PruneOptions options;
  const PruneOrder plain = order_of(crumbs(40), options);
  options.metric = Mat4d::scale({10, 10, 10});
  const PruneOrder large = order_of(crumbs(40), options);
  ASSERT_EQ(plain.steps.size(), large.steps.size());
  for (std::size_t i = 0; i < plain.steps.size(); ++i) {
    EXPECT_NEAR(large.steps[i].error, 10 * plain.steps[i].error, 1e-5 * large.steps[i].error);
  }
  EXPECT_NEAR(large.area[5], 100 * plain.area[5], 1e-9);
}

TEST(PruneOrder, what_holds_a_locked_vertex_stays_and_what_matters_stays_longer) {
  const Mesh mesh = crumbs(50);
  PruneOptions options;
  options.no_move.assign(mesh.vertex_count(), 0);
  options.no_move[3 * 7] = options.no_move[3 * 30] = 1;
  const PruneOrder locked = order_of(mesh, options);
  EXPECT_EQ(locked.steps.size(), 48U);
  for (const PruneStep& v : locked.steps) EXPECT_TRUE(v.part != 7 && v.part != 30);
  options.no_move.clear();
  options.weights.assign(mesh.vertex_count(), 1);
  options.weights[3 * 7] = 1e6F;
  EXPECT_EQ(order_of(mesh, options).steps.size(), 49U);
  for (const PruneStep& v : order_of(mesh, options).steps) EXPECT_NE(v.part, 7U);
  options.weights.resize(2);
  EXPECT_EQ(prune_order(mesh, options).error().code, ErrorCode::bad_argument);
}

TEST(PruneOrder, the_same_for_any_number_of_threads) {
  PruneOptions options;
  options.keep_area = true;
  const Mesh mesh = test::canopy(400);
  const PruneOrder one = *prune_order(mesh, options, Task::root({}, 1));
  EXPECT_TRUE(equal(one, *prune_order(mesh, options, Task::root({}, 2))));
  EXPECT_TRUE(equal(one, *prune_order(mesh, options, Task::root({}, 7))));
  const Task task = Task::root({});
  task.cancel();
  EXPECT_EQ(prune_order(mesh, options, task).error().code, ErrorCode::cancelled);
}

TEST(PruneOrder, can_be_cancelled_at_any_moment) {
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
    const Result<PruneOrder> out = prune_order(mesh, {}, task);
    ASSERT_FALSE(out);
    EXPECT_EQ(out.error().code, ErrorCode::cancelled);
  }
}

TEST(PruneOrder, odd_meshes_are_no_trouble) {
  for (const test::Shape& shape : test::small_shapes()) {
    const PruneOrder thin = order_of(shape.make());
    EXPECT_LT(thin.steps.size(), std::max<std::size_t>(1, thin.parts.count)) << shape.name;
  }
  EXPECT_TRUE(order_of(Mesh{}).steps.empty());
  // Parts without area, and one of which nothing takes part.
  Mesh mesh = crumbs(3);
  mesh.positions[1] = mesh.positions[2] = mesh.positions[0];
  PruneOptions options;
  options.keep_area = true;
  EXPECT_EQ(order_of(mesh, options).steps.size(), 2U);
  options.left_out = {0, 1};
  EXPECT_TRUE(order_of(mesh, options).steps.empty());
}

}  // namespace
}  // namespace lodestone::simplify
