// What works on volumes, and makes them, validates what it is given.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "lodestone/spatial/bvh.h"
#include "lodestone/spatial/surface.h"
#include "lodestone/voxel/boolean.h"
#include "lodestone/voxel/cube_faces.h"
#include "lodestone/voxel/edge_ratio.h"
#include "lodestone/voxel/filter.h"
#include "lodestone/voxel/isosurface.h"
#include "lodestone/voxel/resample.h"
#include "lodestone/voxel/scan.h"
#include "lodestone/voxel/sharp_surface.h"
#include "lodestone/voxel/slab_surface.h"
#include "lodestone/voxel/surface_voxels.h"
#include "lodestone/voxel/voxelize.h"
#include "tests/support/broken.h"

namespace lodestone::voxel {
namespace {

TEST(Entries, of_voxel_refuse_broken_bits) {
  for (const auto& [name, broken] : test::broken_bits()) {
    BitVolume whole = test::whole_bits(), other = broken;
    test::expect_bad_argument(combine(whole, other, BooleanOperation::unite), name);
    test::expect_bad_argument(combine(other, whole, BooleanOperation::unite), name);
    other.grid = whole.grid;
    if (name.find("word") != std::string::npos) {
      test::expect_bad_argument(combine(whole, other, BooleanOperation::unite), name);
    }
    test::expect_bad_argument(cube_faces(broken), name);
    test::expect_bad_argument(edge_ratio_surface(broken, {4, 4, 4}), name);
    test::expect_bad_argument(downsample(broken, {4, 4, 4}), name);
    test::expect_bad_argument(downsample_thin(broken, {4, 4, 4}), name);
  }
}

TEST(Entries, of_voxel_refuse_values_that_do_not_fill_their_grid) {
  const Result<spatial::Surface> surface = spatial::flatten(test::whole_model());
  ASSERT_TRUE(surface);
  const spatial::Bvh tree(*surface);
  const std::vector<float> floats(26);
  const std::vector<std::uint8_t> bytes(26);
  VoxelGrid grid;
  grid.size = {3, 3, 3};
  const VolumeView<float> few{grid, floats};
  const VolumeView<std::uint8_t> few_bytes{grid, bytes};
  test::expect_bad_argument(isosurface(few), "isosurface");
  test::expect_bad_argument(isosurface(few_bytes), "isosurface");
  test::expect_bad_argument(sharp_surface(few_bytes, tree), "sharp");
  test::expect_bad_argument(median(few, 1), "median");
  test::expect_bad_argument(as_float(few), "floats");
  test::expect_bad_argument(gaussian({grid, floats}, {1, 1, 1}), "gaussian");
  grid.spacing.x = NAN;
  const std::vector<float> all(27);
  test::expect_bad_argument(isosurface(VolumeView<float>{grid, all}), "isosurface");
  test::expect_bad_argument(median(VolumeView<float>{grid, all}, 1), "median");
}

TEST(Entries, of_voxel_refuse_a_broken_surface_and_grid) {
  const Result<spatial::Surface> whole = spatial::flatten(test::whole_model());
  ASSERT_TRUE(whole);
  const Result<VoxelGrid> grid = grid_around(whole->bounds, 16, 4);
  ASSERT_TRUE(grid);
  const auto all_refuse = [](const spatial::Surface& surface, const VoxelGrid& in, const std::string& name) {
    for (const FillRule fill : {FillRule::parity, FillRule::nonzero, FillRule::winding, FillRule::shrinkwrap}) {
      test::expect_bad_argument(voxelize(surface, in, {fill}), name);
    }
    test::expect_bad_argument(surface_voxels(surface, in), name);
    test::expect_bad_argument(shrinkwrap(surface, in, 2), name);
    test::expect_bad_argument(slab_surface(surface, in, in.size), name);
  };
  spatial::Surface broken = *whole;
  broken.triangles[4][1] = 1'000'000;
  all_refuse(broken, *grid, "triangle");
  broken = *whole;
  broken.positions[0].y = INFINITY;
  all_refuse(broken, *grid, "position");
  VoxelGrid flat = *grid;
  flat.spacing.z = 0;
  all_refuse(*whole, flat, "grid");
}

TEST(Entries, of_voxel_refuse_broken_points) {
  const Mesh mesh = test::whole_model().meshes[0];
  for (const auto& [name, cloud, line] : test::broken_clouds()) {
    test::expect_refused(scan_solid(cloud), line, name);
    test::expect_bad_argument(scan_distance(cloud), name);
    test::expect_refused(trim_to_points(mesh, cloud, 1), line, name);
  }
  for (const auto& [name, model, line, is_mesh] : test::broken_models()) {
    if (!is_mesh) continue;
    test::expect_refused(trim_to_points(model.meshes[0], test::whole_cloud(), 1),
                         "box" + line.substr(line.find(')') + 1), name);
  }
}

}  // namespace
}  // namespace lodestone::voxel
