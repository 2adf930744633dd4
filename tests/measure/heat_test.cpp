#include "lodestone/measure/heat.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lodestone/core/topology.h"
#include "lodestone/measure/distance.h"
#include "lodestone/measure/hausdorff.h"
#include "support/shapes.h"

namespace lodestone::measure {
namespace {

const std::vector<float>& stream(const Heat& heat, std::size_t i) {
  return std::get<std::vector<float>>(heat.model.meshes[0].attributes[i].values);
}

// A square of two triangles, and the same with a pyramid of height 0.3 on top: all corners of the square lie on it.
Model pyramid() {
  return make_model(test::make_mesh({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5F, 0.5F, 0.3F}},
                                    {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}));
}
Model square() {
  return make_model(test::make_mesh({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}));
}

TEST(Heat, sees_what_lies_between_the_corners) {
  const auto heat = heat_map(square(), pyramid());
  ASSERT_TRUE(heat);
  EXPECT_EQ(heat->triangles, 2U);
  EXPECT_GT(heat->model.meshes[0].triangles.size(), 2U);
  const auto truth = hausdorff(square(), pyramid(), 1e-4);
  EXPECT_NEAR(heat->largest, truth->forward.upper, 0.02 * truth->forward.upper);
  EXPECT_LE(heat->largest, truth->forward.upper * (1 + 1e-6));
  EXPECT_EQ(heat->model.meshes[0].attributes[0].name, "_ERROR");
  EXPECT_FLOAT_EQ(static_cast<float>(heat->largest),
                  *std::max_element(stream(*heat, 0).begin(), stream(*heat, 0).end()));
}

TEST(Heat, splitting_keeps_the_surface) {
  Mesh flat = test::torus(30);
  for (Vec3f& p : flat.positions) p.z *= 0.8F;
  const auto heat = heat_map(make_model(test::torus(12)), make_model(flat), {.tolerance = 0.01});
  ASSERT_TRUE(heat);
  const Mesh& mesh = heat->model.meshes[0];
  EXPECT_GT(mesh.triangles.size(), test::torus(12).triangles.size());
  const Topology topology = topology_of(mesh);
  EXPECT_TRUE(topology.closed && topology.manifold);
  EXPECT_NEAR(area_of(mesh), area_of(test::torus(12)), 1e-4);
  EXPECT_NEAR(volume_of(mesh), volume_of(test::torus(12)), 1e-4);
}

TEST(Heat, colours_end_where_nearly_all_area_is) {
  const auto heat = heat_map(square(), pyramid());
  ASSERT_TRUE(heat);
  EXPECT_GT(heat->percentile_99, 0);
  EXPECT_LE(heat->percentile_99, heat->largest);
  EXPECT_EQ(heat->range, heat->percentile_99);
  const auto sampled = distance(square(), pyramid(), {100'000, 1, false});
  EXPECT_NEAR(heat->percentile_99, sampled->forward.percentile_99, 0.01 * heat->percentile_99);
}

// A needle on a plane: all but a speck of the area is nothing but rounding away, and must not look like something.
TEST(Heat, a_single_spike_is_what_shows) {
  Mesh spiked = test::grid(50);
  spiked.positions[51 * 25 + 25].z = 0.05F;
  const auto heat = heat_map(make_model(spiked), make_model(test::grid(2)));
  ASSERT_TRUE(heat);
  EXPECT_NEAR(heat->largest, 0.05, 1e-6);
  EXPECT_NEAR(heat->range, 0.0025, 1e-6);
  const auto other_way = heat_map(make_model(test::grid(1)), make_model(spiked));
  EXPECT_GT(other_way->largest, 0.005) << "found although neither corners nor middles of the two triangles see it";
  EXPECT_EQ(heat_map(make_model(spiked), make_model(spiked))->range, 0);
}

TEST(Heat, coincident_distant_and_flat_models) {
  const Model torus = make_model(test::torus(20));
  const auto same = heat_map(torus, torus);
  ASSERT_TRUE(same);
  EXPECT_LT(same->largest, 1e-6);
  EXPECT_EQ(same->range, 0);
  Mesh moved = test::torus(20);
  moved.offset = {1e6, 0, 0};
  const auto apart = heat_map(torus, make_model(moved));
  ASSERT_TRUE(apart);
  EXPECT_NEAR(apart->largest, 1e6, 10);
  const Model point = make_model(test::make_mesh({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, {{0, 1, 2}}));
  EXPECT_TRUE(heat_map(point, torus));
  EXPECT_TRUE(heat_map(torus, point));
  EXPECT_EQ(heat_map(torus, Model{}).error().code, ErrorCode::empty);
}

TEST(Heat, stops_before_too_many_triangles) {
  const auto heat = heat_map(square(), pyramid(), {.tolerance = 1e-6, .shortest_side = 0, .most_triangles = 500});
  ASSERT_TRUE(heat);
  EXPECT_LE(heat->model.meshes[0].triangles.size(), 500U);
}

TEST(Heat, same_bytes_for_any_thread_count) {
  const Model a = make_model(test::torus(40)), b = make_model(test::torus(13));
  const auto one = heat_map(a, b, {}, Task::root({}, 1)), seven = heat_map(a, b, {}, Task::root({}, 7));
  EXPECT_EQ(one->model.meshes[0].triangles, seven->model.meshes[0].triangles);
  EXPECT_EQ(stream(*one, 0), stream(*seven, 0));
  EXPECT_EQ(stream(*one, 1), stream(*seven, 1));
}

}  // namespace
}  // namespace lodestone::measure
