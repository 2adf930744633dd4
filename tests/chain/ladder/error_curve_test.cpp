#include <gtest/gtest.h>

#include <cmath>

#include "lodestone/chain/ladder/build_ladder.h"
#include "lodestone/chain/ladder/error_curve_detail.h"
#include "lodestone/chain/ladder/thin_model.h"
#include "support/shapes.h"

namespace lodestone::chain {
namespace {

using detail::most_in_line;

TEST(ErrorCurve, is_twice_what_the_levels_before_lead_one_to_expect) {
  EXPECT_TRUE(std::isinf(most_in_line({}, 100, 1, false))) << "nothing is known";
  EXPECT_TRUE(std::isinf(most_in_line({{1000, 0.0}}, 100, 1, false))) << "nor from the original";
  EXPECT_DOUBLE_EQ(most_in_line({{1'000'000, 0.01}}, 500'000, 1, false), 0.04) << "half the triangles, twice the error";
  EXPECT_DOUBLE_EQ(most_in_line({{2'000'000, 0.008}, {1'000'000, 0.01}}, 500'000, 1, false), 0.04);
  EXPECT_NEAR(most_in_line({{2'000'000, 0.003}, {1'000'000, 0.01}}, 250'000, 1, false), 0.16, 1e-12)
      << "a steep curve is followed";
  EXPECT_DOUBLE_EQ(most_in_line({{1000, 1e-4}}, 100, 1, false), 0.08) << "so few triangles can't do better";
  EXPECT_DOUBLE_EQ(most_in_line({{1000, 1e-4}}, 100, 1, true), 0.32) << "nor can so few parts";
  EXPECT_TRUE(std::isinf(most_in_line({{1'000'000, 1e-6}}, 100'000, 1, false)))
      << "flat parts tell nothing of the rest";
  EXPECT_DOUBLE_EQ(most_in_line({{1'000'000, 2e-4}, {900'000, 1e-6}}, 1'000'000, 1, false), 1e-3) << "is no ruin";
}

// A ball, half of whose triangles sit in many small tetrahedra that no collapse can shrink, so that what is left of it
// would be ruined.
Mesh ball_among_crumbs(int crumbs) {
  Mesh mesh = test::sphere(24);
  for (int i = 0; i < crumbs; ++i) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const Vec3f at{2.0F + 0.05F * static_cast<float>(i % 10), 0.05F * static_cast<float>(i / 10), 0};
    for (const Vec3f& p : test::tetrahedron().positions)
      mesh.positions.push_back({at.x + 0.01F * p.x, at.y + 0.01F * p.y, at.z + 0.01F * p.z});
    for (const Triangle& t : test::tetrahedron().triangles)
      mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  return mesh;
}

LadderOptions with_ratios(std::vector<double> ratios) {
  LadderOptions options;
  options.ratios = std::move(ratios);
  options.distance.samples = 10'000;
  return options;
}

TEST(BuildLadder, ends_before_errors_jump_unless_forced) {
  const Mesh mesh = ball_among_crumbs(200);
  LadderOptions options = with_ratios({0.6, 0.45, 0.1});
  const auto kept = build_ladder(make_model(mesh), options);
  ASSERT_TRUE(kept);
  options.force = true;
  const auto forced = build_ladder(make_model(mesh), options);
  ASSERT_TRUE(forced);
  const auto& levels = kept->ladder.levels;
  const auto& ruined = forced->ladder.levels.back();
  ASSERT_GE(levels.size(), 3U);
  std::vector<detail::CurvePoint> before;
  for (std::size_t i = 0; i + 1 < levels.size(); ++i)
    before.push_back({levels[i].triangles, levels[i].error.measured_error});
  const double most = most_in_line(before, levels.back().triangles, levels.back().error.diagonal, false);
  EXPECT_LE(levels.back().error.measured_error, most) << "the last level is in line";
  EXPECT_GT(ruined.error.measured_error, 4 * levels.back().error.measured_error) << "what would have come";
  EXPECT_LT(ruined.triangles, levels.back().triangles);
  ASSERT_EQ(kept->shortfalls.size(), 1U);
  EXPECT_EQ(kept->shortfalls[0].level, 3U);
  EXPECT_NE(kept->shortfalls[0].reason.find("errors jump"), std::string::npos) << kept->shortfalls[0].reason;
}

// A plate, finely meshed, with ten by ten bumps: at first only flat triangles go, which costs nothing; then the bumps
// begin to be coarser, as they should.
Mesh plate_with_bumps() {
  constexpr int n = 160;
  Mesh plate = test::grid(n, 1.0F / n);
  for (Vec3f& p : plate.positions) {
    const float x = 10 * p.x - std::floor(10 * p.x) - 0.5F, y = 10 * p.y - std::floor(10 * p.y) - 0.5F;
    p.z = 0.03F * std::max(0.0F, 1 - (x * x + y * y) / (0.35F * 0.35F));
  }
  return plate;
}

TEST(BuildLadder, goes_on_when_flat_parts_are_used_up) {
  const auto r = build_ladder(make_model(plate_with_bumps()), with_ratios({0.7, 0.4, 0.1, 0.05}));
  ASSERT_TRUE(r);
  EXPECT_TRUE(r->shortfalls.empty()) << r->shortfalls[0].reason;
  ASSERT_EQ(r->ladder.levels.size(), 5U);
  const auto& first = r->ladder.levels[1];
  EXPECT_LT(first.error.measured_error, 1e-4 * first.error.diagonal) << "flat parts cost nothing";
  EXPECT_GT(r->ladder.levels[2].error.measured_error, 3 * first.error.measured_error);
}

TEST(SimplifyModel, stops_before_errors_jump_where_a_count_cannot_be_reached) {
  const Model model = make_model(ball_among_crumbs(200));
  SimplifyModelOptions options;
  options.target_triangles = 10;
  options.distance.samples = 10'000;
  const auto kept = simplify_model(model, options);
  options.force = true;
  const auto forced = simplify_model(model, options);
  ASSERT_TRUE(kept && forced);
  EXPECT_LT(2 * kept->level.error.measured_error, forced->level.error.measured_error);
  EXPECT_NE(kept->shortfall.find("errors jump"), std::string::npos) << kept->shortfall;
}

TEST(BuildLadder, what_is_left_without_doubled_faces_is_a_level) {
  Mesh doubled = test::grid(20, 0.1F);
  const std::vector<Triangle> once = doubled.triangles;
  doubled.triangles.insert(doubled.triangles.end(), once.begin(), once.end());
  const auto r = build_ladder(make_model(doubled), with_ratios({0.6, 0.25}));
  ASSERT_TRUE(r);
  EXPECT_TRUE(r->shortfalls.empty());
  ASSERT_EQ(r->ladder.levels.size(), 3U);
  EXPECT_EQ(r->ladder.levels[1].triangles, 800U);
  EXPECT_LE(r->ladder.levels[2].triangles, 400U);
  LadderOptions by_error = with_ratios({});
  by_error.errors = {1e-5};
  const auto near = build_ladder(make_model(doubled), by_error);
  ASSERT_TRUE(near);
  ASSERT_EQ(near->ladder.levels.size(), 2U) << "within any error";
  EXPECT_LE(near->ladder.levels[1].triangles, 800U);
}

TEST(ThinModel, leaves_are_told_from_solids) {
  const ThinShare tree = thin_share(make_model(test::canopy(400)));
  EXPECT_EQ(tree.parts, 401U);
  EXPECT_TRUE(needs_keep_area(tree, 100));
  EXPECT_FALSE(needs_keep_area(tree, 100'000)) << "no part is in want";
  EXPECT_FALSE(needs_keep_area(thin_share(make_model(ball_among_crumbs(200))), 1)) << "most of it is the ball";
  EXPECT_FALSE(needs_keep_area(thin_share(make_model(test::torus(20))), 1));
}

}  // namespace
}  // namespace lodestone::chain
