// What makes surfaces of models validates what it is given.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "lodestone/spatial/join.h"
#include "lodestone/spatial/snap.h"
#include "lodestone/spatial/surface.h"
#include "tests/support/broken.h"

namespace lodestone::spatial {
namespace {

TEST(Entries, of_spatial_refuse_what_is_broken) {
  for (const auto& [name, model, line, mesh] : test::broken_models()) {
    test::expect_refused(flatten(model), line, name);
    if (!mesh) continue;
    Mesh broken = model.meshes[0];
    test::expect_refused(join_parts(broken, 0.1), "box" + line.substr(line.find(')') + 1), name);
  }
}

TEST(Entries, of_spatial_refuse_positions_that_are_not_finite) {
  std::vector<Vec3f> positions(4);
  test::expect_bad_argument(snap_positions(positions, 0.1, {1, 0, 0}), "fixed");
  positions[3].y = NAN;
  test::expect_bad_argument(snap_positions(positions, 0.1), "NaN");
}

TEST(Entries, surfaces_can_be_validated) {
  const Result<Surface> whole = flatten(test::whole_model());
  ASSERT_TRUE(whole);
  EXPECT_TRUE(validate(*whole));
  Surface broken = *whole;
  broken.triangles[4][1] = 8;
  test::expect_refused(validate(broken), "surface: triangle 4 names position 8 of 8", "triangle");
  broken = *whole;
  broken.positions[3].z = NAN;
  test::expect_refused(validate(broken), "surface: position 3 is not finite or farther than 1e+150 from the origin",
                       "position");
}

}  // namespace
}  // namespace lodestone::spatial
