// What makes levels and models validates what it is given.
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "lodestone/chain/ladder/build_ladder.h"
#include "lodestone/chain/ladder/constraints.h"
#include "lodestone/chain/scans/scan_surface.h"
#include "lodestone/chain/voxels/boolean.h"
#include "lodestone/chain/voxels/remesh.h"
#include "lodestone/chain/voxels/solid.h"
#include "lodestone/chain/voxels/volume_surface.h"
#include "lodestone/chain/voxels/voxel_ladder.h"
#include "tests/support/broken.h"

namespace lodestone::chain {
namespace {

TEST(Entries, of_ladders_refuse_a_broken_model) {
  for (const auto& [name, model, line, mesh] : test::broken_models()) {
    LadderOptions options;
    options.ratios = {0.5};
    test::expect_refused(build_ladder(model, options), line, name);
    test::expect_refused(build_voxel_ladder(model, options, {}), line, name);
    options.start = model;
    test::expect_refused(build_ladder(test::whole_model(), options), "start, " + line, name);
    SimplifyModelOptions one;
    one.target_triangles = 6;
    test::expect_refused(simplify_model(model, one), line, name);
    one = {};
    one.max_error = 0.1;
    test::expect_refused(simplify_model(model, one), line, name);
    SimplifyConstraints constraints;
    constraints.spheres = {{{0, 0, 0}, 1, 2, false}};
    test::expect_refused(vertex_constraints(model, constraints), line, name);
  }
}

TEST(Entries, of_solids_refuse_a_broken_model) {
  VoxelOptions voxel;
  VoxelGrid grid;
  grid.size = {8, 8, 8};
  for (const auto& [name, model, line, mesh] : test::broken_models()) {
    RemeshOptions options;
    options.resolution = 8;
    test::expect_refused(remesh(model, options), line, name);
    options.resolution = 0;
    options.triangles = 100;
    test::expect_refused(remesh(model, options), line, name);
    BooleanOptions combining;
    combining.resolution = 8;
    combining.operations = {voxel::BooleanOperation::unite};
    const std::vector<Model> models = {test::whole_model(), model};
    test::expect_refused(boolean(models, combining), "model 2, " + line, name);
    test::expect_refused(choose_fill(model, {}), line, name);
    test::expect_refused(solid_of(model, {}), line, name);
    test::expect_refused(solid_in(model, {}, grid), line, name);
    test::expect_refused(VoxelLevels::create(model, voxel, 8), line, name);
  }
}

TEST(Entries, of_solids_refuse_broken_bits) {
  const Result<Solid> whole = solid_of(test::whole_model(), {});
  ASSERT_TRUE(whole);
  EXPECT_TRUE(VoxelLevels::of_solid(*whole, {}, {}));
  for (const auto& [name, bits] : test::broken_bits()) {
    Solid broken = *whole;
    broken.volume = bits;
    test::expect_bad_argument(VoxelLevels::of_solid(std::move(broken), {}, {}), name);
  }
  Solid broken = *whole;
  broken.surface.triangles[0][0] = 8;
  test::expect_bad_argument(VoxelLevels::of_solid(std::move(broken), {}, {}), "surface");
}

TEST(Entries, of_scans_and_volumes_refuse_what_is_broken) {
  for (const auto& [name, cloud, line] : test::broken_clouds()) {
    test::expect_refused(surface_of_scan(cloud), line, name);
    ScanSurfaceOptions splat;
    splat.splat = true;
    test::expect_refused(surface_of_scan(cloud, splat), line, name);
  }
  const std::vector<float> values(26);
  ScannedVolume volume;
  volume.header.grid.size = {3, 3, 3};
  volume.values = std::span<const float>(values);
  test::expect_refused(surface_of(volume), "volume: 26 values for 3 x 3 x 3 voxels", "values");
}

}  // namespace
}  // namespace lodestone::chain
