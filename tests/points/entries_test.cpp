// What works on points validates what it is given.
#include <gtest/gtest.h>

#include "lodestone/points/normals.h"
#include "tests/support/broken.h"

namespace lodestone::points {
namespace {

TEST(Entries, of_points_refuse_a_broken_cloud) {
  for (const auto& [name, cloud, line] : test::broken_clouds()) {
    test::expect_refused(estimate_normals(cloud), line, name);
    test::expect_refused(orient_normals(cloud), line, name);
  }
}

}  // namespace
}  // namespace lodestone::points
