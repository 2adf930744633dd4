#include "lodestone/core/validate.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "lodestone/core/weld.h"
#include "tests/support/broken.h"
#include "tests/support/shapes.h"

namespace lodestone {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(Validate, whole_things_pass) {
  EXPECT_TRUE(validate(test::whole_model()));
  EXPECT_TRUE(validate(Model{}));
  EXPECT_TRUE(validate(test::whole_cloud()));
  EXPECT_TRUE(validate(test::whole_bits()));
  for (const test::Shape& shape : test::small_shapes()) EXPECT_TRUE(validate(make_model(shape.make()))) << shape.name;
}

TEST(Validate, each_fault_of_a_model_is_told_with_its_place_and_limit) {
  for (const test::BrokenModel& broken : test::broken_models()) {
    test::expect_refused(validate(broken.model), broken.line, broken.name);
    EXPECT_EQ(validate(broken.model.meshes[0]).has_value(), !broken.mesh) << broken.name;
  }
}

// A mesh of a model's materials can stand alone.
TEST(Validate, groups_of_a_model_without_materials_may_name_some) {
  Model model = test::whole_model();
  model.materials.clear();
  EXPECT_TRUE(validate(model));
}

TEST(Validate, later_meshes_and_nameless_ones_are_named_by_number) {
  Model model = test::whole_model();
  model.meshes.push_back(test::cube());
  model.meshes[1].triangles[0][0] = 99;
  test::expect_refused(validate(model), "mesh 1: triangle 0 names wedge 99 of 8", "model");
}

// Chunks on threads: the first offender is told, whichever is found first.
TEST(Validate, of_many_faults_the_first_is_told_for_any_number_of_threads) {
  Mesh mesh = test::grid(300);
  ASSERT_GT(mesh.triangles.size(), std::size_t{2} << 16);
  for (const std::size_t t : {170'000U, 70'001U, 140'000U}) mesh.triangles[t][2] = 1'000'000;
  for (const int threads : {1, 2, 7}) {
    test::expect_refused(validate(mesh, Task::root({}, threads)), "mesh: triangle 70001 names wedge 1000000 of 90601",
                         "grid");
  }
  mesh.positions[80'000].x = mesh.positions[66'000].x = std::numeric_limits<float>::infinity();
  test::expect_refused(validate(mesh), "mesh: vertex 66000 of 90601 has a coordinate that is not finite", "grid");
}

TEST(Validate, a_cancelled_task_leaves_nothing_taken_for_valid) {
  const Task task = Task::root({});
  task.cancel();
  const Result<void> result = validate(test::grid(300), task);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::cancelled);
}

TEST(Validate, ladders_have_a_first_level_and_valid_ones_after_it) {
  Ladder ladder;
  ladder.original = test::whole_model();
  test::expect_refused(validate(ladder), "ladder: it has no levels; the first is the original itself", "empty");
  ladder.levels.resize(3);
  EXPECT_TRUE(validate(ladder));
  for (const test::BrokenModel& broken : test::broken_models()) {
    ladder.levels[2].model = broken.model;
    test::expect_refused(validate(ladder), "level 2, " + broken.line, broken.name);
  }
}

TEST(Validate, points) {
  for (const test::BrokenCloud& broken : test::broken_clouds()) {
    test::expect_refused(validate(broken.cloud), broken.line, broken.name);
  }
}

TEST(Validate, volumes) {
  for (const test::BrokenBits& broken : test::broken_bits()) {
    test::expect_bad_argument(validate(broken.volume), broken.name);
  }
  test::expect_refused(validate(test::broken_bits()[0].volume),
                       "volume: 63 words in rows of 1 for 8 x 8 x 8 voxels, which need 64 in rows of 1", "bits");
  VoxelGrid huge;
  huge.size = {kNone, kNone, kNone};
  test::expect_bad_argument(validate(huge), "more voxels than 64 bits count");

  const std::vector<float> values(8);
  ScannedVolume scan;
  scan.header.grid.size = {2, 2, 2};
  scan.values = std::span<const float>(values);
  EXPECT_TRUE(validate(scan));
  ScannedVolume broken = scan;
  broken.header.grid.size[1] = 3;
  test::expect_refused(validate(broken), "volume: 8 values for 2 x 3 x 2 voxels", "values");
  broken = scan;
  broken.header.to_world.m[14] = kNaN;
  test::expect_refused(validate(broken), "volume: its transform is not finite", "transform");
  broken = scan;
  broken.header.slice_positions = {0};
  test::expect_refused(validate(broken), "volume: there are 1 slice positions for 2 slices", "slices");
  broken.header.slice_positions = {1, 0};
  test::expect_refused(validate(broken), "volume: the slice positions do not rise", "slices");
}

CollapseLog log_of_a_cube() {
  CollapseLog log;
  log.start_triangles = 12;
  log.collapses.resize(1);
  log.collapses[0].removed = 7;
  log.wedges = {{0, 23, 0.5F, true}};
  return log;
}

TEST(Validate, logs_fit_their_mesh) {
  const Mesh mesh = test::cube_with_seams();
  EXPECT_TRUE(validate(log_of_a_cube(), mesh));
  CollapseLog log = log_of_a_cube();
  log.collapses[0].removed = 8;
  test::expect_bad_argument(validate(log, mesh), "vertex");
  log = log_of_a_cube();
  log.collapses[0].position.y = std::numeric_limits<float>::quiet_NaN();
  test::expect_bad_argument(validate(log, mesh), "position");
  log = log_of_a_cube();
  log.collapses[0].removed = log.collapses[0].kept;
  test::expect_bad_argument(validate(log, mesh), "one vertex");
  log = log_of_a_cube();
  log.collapses[0].faces = 13;
  test::expect_refused(validate(log, mesh), "collapse log: 13 triangles vanish of 12 at the start, the mesh has 12",
                       "faces");
  log = log_of_a_cube();
  log.collapses[0].first_wedge = 2;
  test::expect_bad_argument(validate(log, mesh), "first wedge");
  log = log_of_a_cube();
  log.wedges[0].kept = 24;
  test::expect_refused(validate(log, mesh), "collapse log: merge 0 names wedge 24 of 24", "wedge");
  for (const float blend : {1.5F, std::numeric_limits<float>::quiet_NaN()}) {
    log = log_of_a_cube();
    log.wedges[0].blend = blend;
    test::expect_bad_argument(validate(log, mesh), "blend");
  }
  log = log_of_a_cube();
  log.collapses.push_back(log.collapses[0]);
  log.collapses[0].first_wedge = 1;  // after the next one's
  test::expect_bad_argument(validate(log, mesh), "wedges that do not rise");
  log = log_of_a_cube();
  log.dropped = {12};
  test::expect_refused(validate(log, mesh), "collapse log: it leaves out triangle 12 of 12", "dropped");
}

TEST(Entries, of_core_refuse_what_is_broken) {
  const CollapseLog log;
  for (const test::BrokenModel& broken : test::broken_models()) {
    if (!broken.mesh) continue;
    const std::string line = broken.line.substr(broken.line.find(')') + 1);
    test::expect_refused(replay(broken.model.meshes[0], log, 0), "box" + line, broken.name);
    if (line.find("finite") != std::string::npos) continue;  // welding leaves out what no triangle uses
    test::expect_refused(weld_exact(broken.model.meshes[0]), "box" + line, broken.name);
  }
  const Mesh mesh = test::cube_with_seams();
  test::expect_refused(replay(mesh, log, 1), "replay: 1 collapses are asked for, the log has 0", "count");
  CollapseLog other = log_of_a_cube();
  other.collapses[0].kept = 100;
  test::expect_bad_argument(replay(mesh, other, 1), "log of another mesh");
  ReplayOptions options;
  options.left_out.resize(11);
  test::expect_refused(replay(mesh, log, 0, options), "replay: a list of 11 triangles is about 12", "left out");
}

}  // namespace
}  // namespace lodestone
