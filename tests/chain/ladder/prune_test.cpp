// What users of --prune and --keep-area rely on.
#include <gtest/gtest.h>

#include "lodestone/chain/ladder/build_ladder.h"
#include "lodestone/core/parts.h"
#include "lodestone/core/validate.h"
#include "support/shapes.h"

namespace lodestone::chain {
namespace {

LadderOptions options_for(bool prune, bool keep_area, std::vector<double> ratios) {
  LadderOptions options;
  options.distance.samples = 10'000;
  options.ratios = std::move(ratios);
  options.constraints.prune = prune;
  options.constraints.keep_area = keep_area;
  return options;
}

LadderResult built(const Model& model, const LadderOptions& options) {
  auto r = build_ladder(model, options);
  EXPECT_TRUE(r);
  return std::move(*r);
}

double drawn_area(const Model& model) {
  double sum = 0;
  for (const Instance& i : model.instances) sum += area_of(model.meshes[i.mesh]);
  return sum;
}

TEST(Prune, a_canopy_gets_below_its_leaves_and_counts_hold) {
  const Model model = make_model(test::canopy(500));
  const std::vector<double> ratios{0.5, 0.1, 0.02};
  const LadderResult kept = built(model, options_for(false, false, ratios));
  EXPECT_FALSE(kept.shortfalls.empty()) << "a triangle a leaf is the least without";
  const LadderResult r = built(model, options_for(true, false, ratios));
  EXPECT_TRUE(r.shortfalls.empty());
  ASSERT_EQ(r.ladder.levels.size(), 4U);
  for (std::size_t i = 1; i < 4; ++i) {
    const Level& level = r.ladder.levels[i];
    const auto wanted = static_cast<std::size_t>(ratios[i - 1] * static_cast<double>(drawn_triangles(model)) + 0.5);
    EXPECT_EQ(level.triangles, drawn_triangles(level.model));
    EXPECT_LE(level.triangles, wanted);
    EXPECT_GE(level.triangles + 2, wanted);
    EXPECT_GE(level.error.error, r.ladder.levels[i - 1].error.error);
    EXPECT_EQ(level.vanished_parts + parts_of(level.model.meshes[0]).count, 501U);
    EXPECT_TRUE(validate(level.model.meshes[0]));
  }
  EXPECT_EQ(kept.ladder.levels.back().vanished_parts, 0U);
}

TEST(KeepArea, a_canopy_keeps_its_area_at_a_tenth_of_its_triangles) {
  const Model model = make_model(test::canopy(500));
  const double before = drawn_area(model);
  const LadderResult grown = built(model, options_for(false, true, {0.1}));
  ASSERT_EQ(grown.ladder.levels.size(), 2U);
  EXPECT_TRUE(grown.shortfalls.empty());
  EXPECT_GE(drawn_area(grown.ladder.levels[1].model), 0.9 * before);
  EXPECT_LE(drawn_area(grown.ladder.levels[1].model), 1.05 * before);
  const LadderResult melted = built(model, options_for(true, false, {0.1}));
  EXPECT_LT(drawn_area(melted.ladder.levels[1].model), 0.6 * before) << "which it would lose without";
}

TEST(Prune, an_error_target_holds_when_measured) {
  LadderOptions options = options_for(true, false, {});
  options.errors = {0.05, 0.2};
  for (const bool keep_area : {false, true}) {
    options.constraints.keep_area = keep_area;
    const LadderResult r = built(make_model(test::canopy(300)), options);
    ASSERT_EQ(r.ladder.levels.size(), 3U);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_LE(r.ladder.levels[i + 1].error.measured_error, options.errors[i]);
    }
    EXPECT_GT(r.ladder.levels[2].vanished_parts, r.ladder.levels[1].vanished_parts);
  }
}

TEST(Prune, each_mesh_keeps_a_part_and_instances_count) {
  Model model = make_model(test::canopy(100));
  model.meshes.push_back(test::tetrahedron());
  model.instances.push_back({0, Mat4d::translation({9, 0, 0}) * Mat4d::scale({3, 3, 3}), "large"});
  model.instances.push_back({1, Mat4d::translation({0, 9, 0}) * Mat4d::scale({0.01, 0.01, 0.01}), "crumb"});
  LadderOptions options = options_for(true, false, {});
  options.triangles = {300, 1};
  const LadderResult r = built(model, options);
  ASSERT_EQ(r.ladder.levels.size(), 3U);
  for (std::size_t i = 1; i < 3; ++i) {
    const Level& level = r.ladder.levels[i];
    EXPECT_EQ(level.triangles, drawn_triangles(level.model));
    EXPECT_EQ(level.vanished_parts, 2 * (101 - parts_of(level.model.meshes[0]).count)) << "drawn twice";
    EXPECT_FALSE(level.model.meshes[1].triangles.empty());
  }
  EXPECT_EQ(parts_of(r.ladder.levels[2].model.meshes[0]).count, 1U);
}

TEST(Prune, what_is_locked_stays_as_it_is) {
  Model model = make_model(test::canopy(200));
  LadderOptions options = options_for(false, true, {0.3});
  options.constraints.keep_border = true;
  const LadderResult bordered = built(model, options);
  EXPECT_LE(bordered.ladder.levels.back().vanished_parts, 1U) << "leaves are all border, only the trunk is not";
  options.constraints.keep_border = false;
  options.constraints.spheres = {{{0, 0, 3}, 0.8, 1, true}};
  const LadderResult r = built(model, options);
  const Mesh& before = model.meshes[0];
  const Mesh& after = r.ladder.levels[1].model.meshes[0];
  for (const Vec3f& p : before.positions) {
    if (length(p - Vec3f{0, 0, 3}) > 0.8F) continue;
    EXPECT_NE(std::find(after.positions.begin(), after.positions.end(), p), after.positions.end());
  }
}

TEST(Prune, levels_do_not_depend_on_the_other_levels) {
  const Model model = make_model(test::canopy(200));
  const LadderResult both = built(model, options_for(false, true, {0.4, 0.1}));
  const LadderResult alone = built(model, options_for(false, true, {0.1}));
  const Mesh& a = both.ladder.levels[2].model.meshes[0];
  const Mesh& b = alone.ladder.levels[1].model.meshes[0];
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.triangles, b.triangles);
}

}  // namespace
}  // namespace lodestone::chain
