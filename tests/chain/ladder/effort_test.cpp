#include "lodestone/chain/ladder/effort.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "lodestone/chain/ladder/build_ladder.h"
#include "lodestone/core/topology.h"
#include "lodestone/spatial/self_intersections.h"
#include "support/shapes.h"

namespace lodestone::chain {
namespace {

Model bumpy(int rings) {
  Mesh mesh = test::sphere(rings);
  for (Vec3f& p : mesh.positions) {
    p = p * (1 + 0.1F * std::sin(7 * p.x) * std::sin(6 * p.y + 1) * std::sin(5 * p.z + 2));
  }
  return make_model(std::move(mesh));
}

SimplifyModelResult simplified(const Model& model, SimplifyModelOptions options, Effort effort, int threads = 0) {
  options.effort = effort;
  options.distance.samples = 20'000;
  auto made = simplify_model(model, options, Task::root({}, threads));
  EXPECT_TRUE(made) << made.error().what;
  return std::move(*made);
}

SimplifyModelOptions to_triangles(std::size_t triangles) {
  SimplifyModelOptions options;
  options.target_triangles = triangles;
  return options;
}

TEST(Effort, is_never_worse_and_worth_it) {
  const Model model = bumpy(60);
  const SimplifyModelResult fast = simplified(model, to_triangles(700), Effort::fast);
  const SimplifyModelResult normal = simplified(model, to_triangles(700), Effort::normal);
  const SimplifyModelResult best = simplified(model, to_triangles(700), Effort::best);
  EXPECT_EQ(fast.level.method, "edge collapse");
  EXPECT_LE(normal.level.error.measured_error, fast.level.error.measured_error);
  EXPECT_LE(normal.level.error.mean_error, 1.01 * fast.level.error.mean_error);
  EXPECT_LT(best.level.error.measured_error, 0.9 * fast.level.error.measured_error);
  EXPECT_LT(best.level.error.mean_error, 0.95 * fast.level.error.mean_error);
  EXPECT_EQ(best.level.method, "edge collapse, fitted by its error");
  const double volume = volume_of(model.meshes.front());
  EXPECT_NEAR(volume_of(best.level.model.meshes.front()), volume, 1e-4 * volume);
  for (const SimplifyModelResult* r : {&fast, &normal, &best}) {
    EXPECT_LE(r->level.triangles, 700U);
    const Topology t = topology_of(r->level.model.meshes.front());
    EXPECT_TRUE(t.closed && t.manifold);
  }
}

TEST(Effort, needs_fewer_triangles_for_an_error) {
  const Model model = bumpy(36);
  SimplifyModelOptions options;
  options.max_error = 0.01;
  const SimplifyModelResult fast = simplified(model, options, Effort::fast);
  const SimplifyModelResult best = simplified(model, options, Effort::best);
  const SimplifyModelResult normal = simplified(model, options, Effort::normal);
  EXPECT_LE(normal.level.error.measured_error, 0.01);
  EXPECT_LE(normal.level.triangles, fast.level.triangles);
  EXPECT_LE(best.level.error.measured_error, 0.01);
  EXPECT_LT(best.level.triangles, 0.65 * static_cast<double>(fast.level.triangles));
  for (const SimplifyModelResult* r : {&normal, &best}) {
    const Topology t = topology_of(r->level.model.meshes.front());
    EXPECT_TRUE(t.closed && t.manifold);
  }
}

TEST(Effort, locks_do_not_stop_it) {
  SimplifyModelOptions options;
  options.max_error = 0.01;
  options.constraints.spheres.push_back({{0, 0, 1}, 0.1, 1, true});
  const Model model = bumpy(36);
  const SimplifyModelResult fast = simplified(model, options, Effort::fast);
  const SimplifyModelResult best = simplified(model, options, Effort::best);
  EXPECT_LT(best.level.triangles, 0.8 * static_cast<double>(fast.level.triangles));
}

// A mesh that comes down to one triangle beside one that is worth shaping.
TEST(Effort, of_several_meshes_with_an_error) {
  Model model = bumpy(36);
  Mesh flat = test::grid(4);
  for (Vec3f& p : flat.positions) p = p * 0.1F + Vec3f{2, 0, 0};
  model.meshes.push_back(std::move(flat));
  Instance instance;
  instance.mesh = 1;
  model.instances.push_back(instance);
  SimplifyModelOptions options;
  options.max_error = 0.02;
  std::size_t last = static_cast<std::size_t>(-1);
  for (const Effort effort : {Effort::fast, Effort::normal, Effort::best}) {
    const SimplifyModelResult made = simplified(model, options, effort);
    EXPECT_LE(made.level.error.measured_error, 0.02);
    EXPECT_LE(made.level.triangles, last);
    last = made.level.triangles;
  }
}

TEST(Effort, has_the_same_bytes_for_any_thread_count) {
  const Model model = bumpy(50);
  for (const Effort effort : {Effort::normal, Effort::best}) {
    const SimplifyModelResult one = simplified(model, to_triangles(400), effort, 1);
    for (const int threads : {2, 7}) {
      const SimplifyModelResult more = simplified(model, to_triangles(400), effort, threads);
      EXPECT_EQ(one.level.model.meshes[0].positions, more.level.model.meshes[0].positions);
      EXPECT_EQ(one.level.model.meshes[0].triangles, more.level.model.meshes[0].triangles);
    }
  }
}

TEST(Effort, keeps_locked_vertices_and_borders) {
  Model model = make_model(test::grid(40, 0.1F));
  SimplifyModelOptions options = to_triangles(400);
  options.constraints.keep_border = true;
  options.constraints.spheres.push_back({{0.5, 0.5, 0}, 0.2, 1, true});
  const SimplifyModelResult best = simplified(model, options, Effort::best);
  const Mesh& mesh = best.level.model.meshes.front();
  std::size_t border = 0, locked = 0;
  for (const Vec3f& p : model.meshes[0].positions) {
    const bool on_border = p.x <= 0 || p.x >= 1 || p.y <= 0 || p.y >= 1;
    const bool in_sphere = length(to_double(p) - Vec3d{0.5, 0.5, 0}) < 0.2;
    if (!on_border && !in_sphere) continue;
    (on_border ? border : locked) += 1;
    EXPECT_NE(std::find(mesh.positions.begin(), mesh.positions.end(), p), mesh.positions.end());
  }
  EXPECT_GT(border, 0U);
  EXPECT_GT(locked, 0U);
}

TEST(Effort, of_what_is_broken_is_no_worse) {
  for (const Mesh& mesh : {test::moebius(60), test::soup(7, 200, 400), test::grid(20), test::offset_plates(12),
                           test::three_faces_on_an_edge(), test::canopy(30)}) {
    const Model model = make_model(mesh);
    const std::size_t half = std::max<std::size_t>(1, mesh.triangles.size() / 2);
    const SimplifyModelResult fast = simplified(model, to_triangles(half), Effort::fast);
    for (const Effort effort : {Effort::normal, Effort::best}) {
      const SimplifyModelResult shaped = simplified(model, to_triangles(half), effort);
      EXPECT_LE(shaped.level.error.measured_error, fast.level.error.measured_error);
      EXPECT_LE(shaped.level.error.mean_error, 1.01 * fast.level.error.mean_error);
      EXPECT_LE(shaped.level.triangles, fast.level.triangles);
    }
  }
}

TEST(Effort, ladders_stay_in_order) {
  LadderOptions options;
  options.distance.samples = 20'000;
  for (const Effort effort : {Effort::normal, Effort::best}) {
    options.effort = effort;
    const auto made = build_ladder(bumpy(36), options);
    ASSERT_TRUE(made);
    const auto& levels = made->ladder.levels;
    for (std::size_t i = 1; i < levels.size(); ++i) {
      EXPECT_GE(levels[i].error.error, levels[i - 1].error.error);
      EXPECT_GE(levels[i].error.measured_error, levels[i - 1].error.measured_error) << "no level worse than the next";
    }
  }
}

// A level that holds its error only because it is shaped must not end the ladder.
TEST(Effort, errors_that_are_near_each_other_give_a_level_each) {
  LadderOptions options;
  options.distance.samples = 20'000;
  options.errors = {0.01, 0.014, 0.02};
  for (const Effort effort : {Effort::fast, Effort::best}) {
    options.effort = effort;
    const auto made = build_ladder(bumpy(36), options);
    ASSERT_TRUE(made);
    EXPECT_EQ(made->ladder.levels.size(), 4U) << made->shortfalls.size();
    for (std::size_t i = 1; i < made->ladder.levels.size(); ++i) {
      EXPECT_LE(made->ladder.levels[i].error.measured_error, options.errors[i - 1]);
      EXPECT_LT(made->ladder.levels[i].triangles, made->ladder.levels[i - 1].triangles);
    }
  }
}

// Faces of a star-shaped solid look away from its middle; moving must not turn more of them inward.
TEST(Effort, turns_no_face_inward) {
  const auto inward = [](Effort effort) {
    const SimplifyModelResult made = simplified(bumpy(60), to_triangles(700), effort);
    const Mesh& mesh = made.level.model.meshes.front();
    std::size_t count = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const Triangle v = mesh.vertices_of(t);
      const Vec3d a = mesh.position(v[0]), b = mesh.position(v[1]), c = mesh.position(v[2]);
      count += dot(cross(b - a, c - a), a + b + c) > 0 ? 0 : 1;
    }
    return count;
  };
  EXPECT_LE(inward(Effort::best), inward(Effort::fast));
}

// Two shells that are near each other: moving must not push one through the other.
TEST(Effort, adds_no_crossings) {
  for (const float inner : {0.95F, 0.97F, 0.99F}) {
    Mesh shell = bumpy(30).meshes.front();
    const auto count = static_cast<std::uint32_t>(shell.positions.size());
    const std::vector<Vec3f> outer = shell.positions;
    const std::vector<Triangle> outward = shell.triangles;
    for (const Vec3f& p : outer) shell.positions.push_back(p * inner);
    for (const Triangle& t : outward) shell.triangles.push_back({t[0] + count, t[2] + count, t[1] + count});
    const Model model = make_model(shell);
    const auto crossings_of = [&](Effort effort) {
      const SimplifyModelResult made = simplified(model, to_triangles(700), effort);
      if (inner < 0.96F) {
        EXPECT_EQ(made.level.method == "edge collapse", effort == Effort::fast);
      }
      const spatial::Surface surface = *spatial::flatten(made.level.model, {});
      return spatial::self_intersections(spatial::Bvh(surface), {}, {}).size();
    };
    EXPECT_LE(crossings_of(Effort::best), crossings_of(Effort::fast)) << inner;
  }
}

TEST(Effort, can_be_cancelled_while_shaping) {
  SimplifyModelOptions options = to_triangles(2000);
  options.effort = Effort::best;
  options.distance.samples = 1000;
  for (const char* when : {"shaping", "round 1"}) {
    std::atomic<bool> seen = false;
    Task task;
    task = Task::root([&](double, const std::string& label) {
      if (label.find(when) == std::string::npos || seen.exchange(true)) return;
      task.cancel();
    });
    const auto made = simplify_model(bumpy(80), options, task);
    if (!seen) continue;  // labels are told at times only
    ASSERT_FALSE(made);
    EXPECT_EQ(made.error().code, ErrorCode::cancelled);
  }
}

TEST(Effort, can_be_cancelled) {
  const Task task = Task::root({});
  task.cancel();
  SimplifyModelOptions options = to_triangles(100);
  options.effort = Effort::best;
  const auto made = simplify_model(bumpy(20), options, task);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, ErrorCode::cancelled);
}

}  // namespace
}  // namespace lodestone::chain
