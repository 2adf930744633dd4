#include "lodestone/chain/ladder/build_ladder.h"

#include <gtest/gtest.h>

#include "lodestone/core/topology.h"
#include "support/shapes.h"

namespace lodestone::chain {
namespace {

// Fewer samples than users get, so that the sanitizers finish; one test keeps the default.
LadderOptions quick() {
  LadderOptions options;
  options.distance.samples = 10'000;
  return options;
}

LadderResult built(Mesh mesh, const LadderOptions& options = quick()) {
  auto r = build_ladder(make_model(std::move(mesh)), options);
  EXPECT_TRUE(r);
  return std::move(*r);
}

TEST(BuildLadder, halves_by_default_and_measures_every_level) {
  const LadderResult r = built(test::torus(60), {});
  const auto& levels = r.ladder.levels;
  ASSERT_EQ(levels.size(), 5U);
  EXPECT_TRUE(r.shortfalls.empty());
  EXPECT_EQ(levels[0].triangles, 7200U);
  EXPECT_EQ(levels[0].error.error, 0);
  for (std::size_t i = 1; i < levels.size(); ++i) {
    EXPECT_LE(levels[i].triangles, 7200U >> i);
    EXPECT_GE(levels[i].triangles + 2, 7200U >> i);
    EXPECT_GE(levels[i].error.error, levels[i - 1].error.error) << "errors never fall";
    EXPECT_GE(levels[i].error.error, levels[i].error.measured_error);
    EXPECT_GT(levels[i].error.mean_error, 0);
    EXPECT_EQ(levels[i].error.kind, ErrorKind::bounded);
    EXPECT_GE(levels[i].error.samples, 200'000U);
    const auto again = measure::distance(r.ladder.original, r.ladder.model(i));
    EXPECT_EQ(again->trusted_max(), levels[i].error.measured_error) << "what the level says is what measuring says";
    EXPECT_TRUE(topology_of(levels[i].model.meshes[0]).closed);
  }
}

TEST(BuildLadder, ratios_and_counts) {
  LadderOptions options = quick();
  options.ratios = {0.3, 0.1};
  const LadderResult by_ratio = built(test::torus(40), options);
  ASSERT_EQ(by_ratio.ladder.levels.size(), 3U);
  EXPECT_NEAR(static_cast<double>(by_ratio.ladder.levels[1].triangles), 960, 2);
  options.ratios.clear();
  options.triangles = {1000, 200};
  const LadderResult by_count = built(test::torus(40), options);
  ASSERT_EQ(by_count.ladder.levels.size(), 3U);
  EXPECT_LE(by_count.ladder.levels[2].triangles, 200U);
}

TEST(BuildLadder, error_targets_hold_when_measured_and_are_not_wasteful) {
  LadderOptions options = quick();
  options.errors = {0.005, 0.02};
  const LadderResult r = built(test::torus(60), options);
  ASSERT_EQ(r.ladder.levels.size(), 3U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_LE(r.ladder.levels[i + 1].error.measured_error, options.errors[i]);
    EXPECT_GT(r.ladder.levels[i + 1].error.measured_error, 0.5 * options.errors[i]);
  }
  EXPECT_LT(r.ladder.levels[2].triangles, r.ladder.levels[1].triangles);
}

TEST(BuildLadder, what_cannot_shrink_further_ends_early_and_says_why) {
  const LadderResult r = built(test::cube());
  EXPECT_FALSE(r.shortfalls.empty());
  EXPECT_LT(r.ladder.levels.size(), 5U);
  LadderOptions options = quick();
  options.constraints.keep_border = true;
  const LadderResult bordered = built(test::grid(8), options);
  ASSERT_FALSE(bordered.shortfalls.empty());
  EXPECT_NE(bordered.shortfalls[0].reason.find("`keep_border`"), std::string::npos) << bordered.shortfalls[0].reason;
}

TEST(BuildLadder, one_budget_for_all_meshes_spent_where_it_hurts_least) {
  Model model = make_model(test::sphere(24));
  Mesh flat = test::grid(24);
  model.meshes.push_back(flat);
  model.instances.push_back({1, Mat4d::translation({5, 0, 0}), "flat"});
  model.instances.push_back({1, Mat4d::translation({8, 0, 0}), "flat again"});
  const std::size_t drawn = drawn_triangles(model);
  LadderOptions options = quick();
  options.ratios = {0.5};
  auto r = build_ladder(std::move(model), options);
  ASSERT_TRUE(r);
  const Level& level = r->ladder.levels[1];
  EXPECT_LE(level.triangles, drawn / 2);
  EXPECT_EQ(level.triangles, drawn_triangles(level.model));
  EXPECT_LT(level.model.meshes[1].triangles.size(), 60U) << "the flat one gives first";
  EXPECT_EQ(level.model.instances.size(), 3U);
}

TEST(BuildLadder, larger_instances_keep_more) {
  Model model = make_model(test::sphere(20));
  model.meshes.push_back(test::sphere(20));
  model.instances.push_back({1, Mat4d::translation({50, 0, 0}) * Mat4d::scale({10, 10, 10}), "large"});
  LadderOptions options = quick();
  options.ratios = {0.3};
  auto r = build_ladder(std::move(model), options);
  ASSERT_TRUE(r);
  EXPECT_LT(2 * r->ladder.levels[1].model.meshes[0].triangles.size(),
            r->ladder.levels[1].model.meshes[1].triangles.size());
}

TEST(BuildLadder, bad_arguments) {
  const auto code = [](const LadderOptions& options) {
    const auto r = build_ladder(make_model(test::cube()), options);
    return r ? ErrorCode::cancelled : r.error().code;
  };
  LadderOptions options = quick();
  options.levels = 1;
  EXPECT_EQ(code(options), ErrorCode::bad_argument);
  options = quick();
  options.ratios = {0.5};
  options.errors = {0.1};
  EXPECT_EQ(code(options), ErrorCode::bad_argument);
  options = quick();
  options.ratios = {0.1, 0.5};
  EXPECT_EQ(code(options), ErrorCode::bad_argument);
  options.ratios = {1.5};
  EXPECT_EQ(code(options), ErrorCode::bad_argument);
  EXPECT_EQ(build_ladder(Model{}).error().code, ErrorCode::empty);
  const Task task = Task::root({});
  task.cancel();
  EXPECT_EQ(build_ladder(make_model(test::torus(10)), {}, task).error().code, ErrorCode::cancelled);
}

TEST(SimplifyModel, targets) {
  const Model model = make_model(test::torus(40));
  SimplifyModelOptions options;
  options.distance.samples = 10'000;
  EXPECT_FALSE(simplify_model(model, options));
  options.target_triangles = 500;
  auto r = simplify_model(model, options);
  ASSERT_TRUE(r);
  EXPECT_EQ(r->stop, simplify::StopReason::reached_target);
  EXPECT_LE(r->level.triangles, 500U);
  EXPECT_TRUE(r->shortfall.empty());
  options.target_triangles = 0;
  options.max_error = 0.01;
  r = simplify_model(model, options);
  ASSERT_TRUE(r);
  EXPECT_LE(r->level.error.measured_error, 0.01);
  options.max_error = 0;
  options.target_triangles = 1;
  r = simplify_model(model, options);
  ASSERT_TRUE(r);
  EXPECT_FALSE(r->shortfall.empty());
}

TEST(ScreenCoverage, one_row_an_instance_falling_and_ending_in_zero) {
  const LadderResult r = built(test::torus(40));
  const auto rows = screen_coverages(r.ladder);
  ASSERT_EQ(rows.size(), 1U);
  ASSERT_EQ(rows[0].size(), r.ladder.levels.size());
  for (std::size_t i = 1; i < rows[0].size(); ++i) EXPECT_LE(rows[0][i], rows[0][i - 1]);
  EXPECT_EQ(rows[0].back(), 0);
}

TEST(SimplifyModel, welding_by_tolerance_lets_cracked_sheets_collapse_together) {
  // Each triangle has corners of its own, off by a little: nothing could collapse.
  const Mesh whole = test::torus(32);
  Mesh cracked;
  for (std::size_t t = 0; t < whole.triangles.size(); ++t) {
    const auto first = static_cast<std::uint32_t>(cracked.positions.size());
    for (const std::uint32_t v : whole.vertices_of(t)) {
      cracked.positions.push_back(whole.positions[v] + Vec3f{1e-5F * static_cast<float>(t % 7), 0, 0});
    }
    cracked.triangles.push_back({first, first + 1, first + 2});
  }
  SimplifyModelOptions options;
  options.target_triangles = whole.triangles.size() / 4;
  options.distance.samples = 2000;
  const auto apart = simplify_model(make_model(cracked), options);
  ASSERT_TRUE(apart);
  EXPECT_FALSE(apart->shortfall.empty());
  options.constraints.weld_tolerance = 1e-3;
  const auto joined = simplify_model(make_model(cracked), options);
  ASSERT_TRUE(joined);
  EXPECT_TRUE(joined->shortfall.empty()) << joined->shortfall;
  EXPECT_LE(joined->level.triangles, options.target_triangles);
}

}  // namespace
}  // namespace lodestone::chain
