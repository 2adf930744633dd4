#include "lodestone/chain/voxels/remesh.h"

#include <gtest/gtest.h>

#include "lodestone/chain/voxels/boolean.h"
#include "lodestone/chain/voxels/voxel_ladder.h"
#include "lodestone/core/topology.h"
#include "support/shapes.h"

namespace lodestone::chain {
namespace {

RemeshOptions asking(std::size_t triangles, double error = 0, bool then_collapse = false,
                     std::uint32_t resolution = 0) {
  RemeshOptions options;
  options.triangles = triangles;
  options.error = error;
  options.then_collapse = then_collapse;
  options.resolution = resolution;
  return options;
}

bool closed_manifold(const Model& model) {
  const Topology t = topology_of(model.meshes.front());
  return t.closed && t.manifold && t.duplicate_faces == 0;
}

TEST(Remesh, reaches_a_count_within_a_tenth) {
  const Model sphere = make_model(test::sphere(64));
  for (const std::size_t wanted : {2000U, 10'000U, 50'000U}) {
    const auto made = remesh(sphere, asking(wanted));
    ASSERT_TRUE(made) << made.error().what;
    EXPECT_TRUE(made->shortfall.empty()) << made->shortfall;
    EXPECT_LE(made->level.triangles, wanted);
    EXPECT_GE(made->level.triangles, wanted * 9 / 10);
    EXPECT_TRUE(closed_manifold(made->level.model));
  }
}

TEST(Remesh, reaches_an_error) {
  const Model torus = make_model(test::torus(48));
  for (const double wanted : {0.1, 0.02}) {
    const auto made = remesh(torus, asking(0, wanted));
    ASSERT_TRUE(made) << made.error().what;
    EXPECT_TRUE(made->shortfall.empty());
    EXPECT_LE(made->level.error.measured_error, wanted);
    EXPECT_GT(made->level.error.measured_error, wanted / 4) << "the coarsest that holds, not any";
  }
}

TEST(Remesh, collapses_to_a_count_exactly) {
  const auto made = remesh(make_model(test::torus(48)), asking(1000, 0, true));
  ASSERT_TRUE(made) << made.error().what;
  EXPECT_EQ(made->level.triangles, 1000U);
  EXPECT_EQ(made->level.method, "voxels and edge collapse");
  EXPECT_TRUE(closed_manifold(made->level.model));
  const auto plain = remesh(make_model(test::torus(48)), asking(1000));
  ASSERT_TRUE(plain);
  EXPECT_LT(made->level.error.mean_error, plain->level.error.mean_error);
}

TEST(Remesh, is_closed_whatever_the_input) {
  for (const test::Shape& shape : test::small_shapes()) {
    for (const VertexPlacement placement :
         {VertexPlacement::project, VertexPlacement::sharp, VertexPlacement::linear, VertexPlacement::edge_ratio}) {
      RemeshOptions options;
      options.resolution = 24;
      options.voxel.placement = placement;
      options.measure = false;
      const auto made = remesh(make_model(shape.make()), options);
      if (!made) {
        EXPECT_EQ(made.error().code, ErrorCode::empty) << shape.name << ": " << made.error().what;
        continue;
      }
      const Topology t = topology_of(made->level.model.meshes.front());
      EXPECT_TRUE(t.closed) << shape.name;
      EXPECT_EQ(t.nonmanifold_edges + t.inconsistent_edges + t.duplicate_faces, 0U) << shape.name;
    }
  }
}

TEST(Remesh, keeps_the_volume_on_request) {
  RemeshOptions options;
  options.resolution = 12;
  options.voxel.placement = VertexPlacement::linear;
  const Model sphere = make_model(test::sphere(64));
  const double wanted = volume_of(sphere.meshes[0]);
  const auto off = [&] { return std::abs(volume_of(remesh(sphere, options)->level.model.meshes[0]) / wanted - 1); };
  const double usual = off();
  options.voxel.keep_volume = true;
  EXPECT_LT(off(), 0.004) << "the solid itself is off by some";
  EXPECT_LT(off(), usual);
}

TEST(Remesh, names_what_vanished) {
  Model model = make_model(test::sphere(32));
  Mesh speck = test::cube();
  for (Vec3f& p : speck.positions) p = p * 0.01F + Vec3f{0, 0, 1.5F};
  model.meshes.push_back(std::move(speck));
  model.instances.push_back({1, {}, "button"});
  RemeshOptions options;
  options.resolution = 20;
  const auto made = remesh(model, options);
  ASSERT_TRUE(made);
  ASSERT_FALSE(made->warnings.empty());
  EXPECT_NE(made->warnings.back().find("button"), std::string::npos) << made->warnings.back();
  options.voxel.keep_thin = true;
  options.voxel.supersample = 16;
  const auto kept = remesh(model, options);
  ASSERT_TRUE(kept);
  EXPECT_EQ(topology_of(kept->level.model.meshes[0]).components, 2U);
}

TEST(Remesh, says_how_much_memory_is_missing) {
  RemeshOptions options;
  options.resolution = 16'384;
  options.voxel.placement = VertexPlacement::linear;
  const auto made = remesh(make_model(test::sphere(8)), options);
  ASSERT_FALSE(made);
  EXPECT_TRUE(made.error().code == ErrorCode::out_of_memory || made.error().code == ErrorCode::bad_argument);
}

TEST(Remesh, refuses_two_targets) {
  const Model sphere = make_model(test::sphere(8));
  EXPECT_FALSE(remesh(sphere, asking(100, 0.1)));
  EXPECT_FALSE(remesh(sphere, asking(100, 0, false, 32)));
  EXPECT_FALSE(remesh(sphere, asking(0, 0, true)));
}

TEST(VoxelLadder, has_a_level_for_each_target) {
  for (const bool then_collapse : {false, true}) {
    LadderOptions options;
    options.triangles = {8000, 2000, 500};
    VoxelLadderOptions voxels;
    voxels.then_collapse = then_collapse;
    const auto made = build_voxel_ladder(make_model(test::sphere(96)), options, voxels);
    ASSERT_TRUE(made) << made.error().what;
    ASSERT_EQ(made->ladder.levels.size(), 4U);
    double error = 0;
    for (std::size_t i = 1; i < 4; ++i) {
      const Level& level = made->ladder.levels[i];
      EXPECT_LE(level.triangles, options.triangles[i - 1]);
      EXPECT_GE(level.error.error, error);
      EXPECT_GT(level.error.measured_error, 0);
      error = level.error.error;
      EXPECT_TRUE(closed_manifold(level.model));
    }
  }
}

TEST(Boolean, volumes_add_up) {
  Mesh ball = test::sphere(48), moved = ball;
  for (Vec3f& p : moved.positions) p.x += 1;
  const std::vector<Model> models{make_model(ball), make_model(moved)};
  const auto volume = [&](voxel::BooleanOperation operation) {
    BooleanOptions options;
    options.resolution = 96;
    options.operations = {operation};
    const auto made = boolean(models, options);
    EXPECT_TRUE(made) << made.error().what;
    EXPECT_TRUE(closed_manifold(made->model));
    return volume_of(made->model.meshes[0]);
  };
  const double one = volume_of(ball), both = volume(voxel::BooleanOperation::unite),
               common = volume(voxel::BooleanOperation::intersect), rest = volume(voxel::BooleanOperation::subtract);
  EXPECT_NEAR(both + common, 2 * one, 0.01 * one);
  EXPECT_NEAR(rest + common, one, 0.01 * one);
  // Two unit balls whose centres are 1 apart share 5/12 pi.
  EXPECT_NEAR(common, 5 * 3.14159265 / 12, 0.02);
  EXPECT_FALSE(boolean(models, {}));
}

}  // namespace
}  // namespace lodestone::chain
