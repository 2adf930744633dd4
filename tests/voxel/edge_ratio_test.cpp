#include "lodestone/voxel/edge_ratio.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lodestone/core/model.h"
#include "lodestone/core/topology.h"
#include "lodestone/spatial/surface.h"
#include "lodestone/voxel/voxelize.h"
#include "support/shapes.h"

namespace lodestone::voxel {
namespace {

BitVolume ball(std::uint32_t resolution) {
  const auto surface = spatial::flatten(make_model(test::sphere(80)));
  return voxelize(*surface, *grid_over(surface->bounds, {resolution, resolution, resolution}))->volume;
}

double mean_radius(const Mesh& mesh) {
  double sum = 0;
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) sum += length(mesh.position(v));
  return sum / static_cast<double>(mesh.vertex_count());
}

TEST(EdgeRatio, finds_the_sphere) {
  const BitVolume solid = ball(200);
  const auto mesh = edge_ratio_surface(solid, {40, 40, 40});
  ASSERT_TRUE(mesh);
  const Topology t = topology_of(*mesh);
  EXPECT_TRUE(t.closed && t.manifold);
  EXPECT_EQ(t.vertices + t.triangles, t.edges + 2);
  EXPECT_NEAR(mean_radius(*mesh), 1, 0.005);
}

// The step after the change lies, on the side where edges leave the solid, half a step too far out, and on the other
// half a step too far in: the middle of the whole surface moves towards the far ends.
TEST(EdgeRatio, of_the_paper_is_off_by_half_a_step) {
  const BitVolume solid = ball(200);
  const auto middle = [&](bool between) {
    EdgeRatioOptions options;
    options.between_steps = between;
    const auto mesh = edge_ratio_surface(solid, {40, 40, 40}, options);
    Vec3d sum;
    for (std::uint32_t v = 0; v < mesh->vertex_count(); ++v) sum += mesh->position(v);
    return sum / static_cast<double>(mesh->vertex_count());
  };
  const double step = 2.0 / 200;  // a small voxel
  EXPECT_LT(length(middle(true)), 0.05 * step);
  // A vertex lies on an edge along one of three axes, so each axis sees a third of the half step.
  EXPECT_NEAR(middle(false).x, step / 2 / 3, 0.05 * step);
  EXPECT_NEAR(middle(false).y, step / 2 / 3, 0.05 * step);
  EXPECT_NEAR(middle(false).z, step / 2 / 3, 0.05 * step);
}

TEST(EdgeRatio, refuses_what_can_not_be) {
  const BitVolume solid = ball(16);
  EXPECT_FALSE(edge_ratio_surface(solid, {0, 4, 4}));
  EXPECT_FALSE(edge_ratio_surface(solid, {4, 17, 4}));
  EdgeRatioOptions options;
  options.threshold = 1;
  EXPECT_FALSE(edge_ratio_surface(solid, {4, 4, 4}, options));
  BitVolume nothing(solid.grid);
  EXPECT_EQ(edge_ratio_surface(nothing, {4, 4, 4}).error().code, ErrorCode::empty);
}

}  // namespace
}  // namespace lodestone::voxel
