// Reading the shared point clouds: counts as their table tells them, or a line that says why not.
#include "lodestone/io/points/read.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <ostream>

namespace lodestone {
namespace {

namespace fs = std::filesystem;

struct Known {
  const char* file;
  std::size_t points;  // that come out; 0 = it is refused
  std::size_t stored = 0;
  bool normals = false, colors = false;
  const char* says = "";  // a part of the error's line

  friend std::ostream& operator<<(std::ostream& out, const Known& known) { return out << known.file; }
};

class SharedPoints : public ::testing::TestWithParam<Known> {};

TEST_P(SharedPoints, has_the_count_of_its_table_or_says_why_not) {
  const Known& known = GetParam();
  const auto cloud = io::read_points(fs::path(LODESTONE_SHARED_DATA) / "points" / known.file);
  if (known.points == 0) {
    ASSERT_FALSE(cloud);
    EXPECT_NE(cloud.error().line().find(known.file), std::string::npos) << cloud.error().line();
    EXPECT_NE(cloud.error().line().find(known.says), std::string::npos) << cloud.error().line();
    return;
  }
  ASSERT_TRUE(cloud) << cloud.error().line();
  EXPECT_EQ(cloud->size(), known.points);
  EXPECT_EQ(cloud->file_points, known.stored);
  EXPECT_EQ(!cloud->normals.empty(), known.normals);
  EXPECT_EQ(!cloud->colors.empty(), known.colors);
}

INSTANTIATE_TEST_SUITE_P(
    Table, SharedPoints,
    ::testing::Values(
        Known{"autzen_trim.las", 110000, 110000, false, true}, Known{"autzen-thin.las", 10653, 10653, false, true},
        Known{"1.2-with-color.las", 1065, 1065, false, true}, Known{"test1_4.las", 1000, 1000},
        Known{"extrabytes.las", 1065, 1065, false, true}, Known{"las_1.0_0.las", 1, 1}, Known{"las_1.1_1.las", 1, 1},
        Known{"gps-time-nan.las", 1, 1}, Known{"bad_vlr_count.las", 10, 10, false, true},
        Known{"no-points.las", 0, 0, false, false, "has no points"},
        Known{"garbage_nVariableLength.las", 0, 0, false, false, "719 points"},  // the last is cut off
        Known{"simple.laz", 0, 0, false, false, "pdal translate"},
        Known{"1.2-with-color.copc.laz", 0, 0, false, false, "pdal translate"},
        Known{"1.2-with-color.ptx", 0, 0, false, false, "pdal translate"}, Known{"bun0.pcd", 397, 397, true},
        Known{"lamppost.pcd", 1771, 1771}, Known{"colored_cloud.pcd", 1000, 1000, true, true},
        Known{"milk.pcd", 13704, 13704}, Known{"milk_color.pcd", 13704, 13704, false, true},
        Known{"milk_color.ply", 13704, 13704, false, true}, Known{"chef.pcd", 5092, 5092, true},
        Known{"chef_normals.xyz", 5092, 5092, true}, Known{"cturtle.pcd", 167198, 167198},
        Known{"office1.pcd", 254456, 307200, false, true}, Known{"pdal_autzen-utm.pcd", 1065, 1065, false, true},
        Known{"pdal_missingheader.pcd", 0, 0, false, false, "no header"}),
    [](const auto& param) {
      std::string name = param.param.file;
      for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
      return name;
    });

TEST(SharedPoints, formats_of_one_cloud_agree) {
  const fs::path folder = fs::path(LODESTONE_SHARED_DATA) / "points";
  const auto pcd = io::read_points(folder / "milk_color.pcd"), ply = io::read_points(folder / "milk_color.ply");
  ASSERT_TRUE(pcd && ply);
  EXPECT_EQ(pcd->positions, ply->positions);
  EXPECT_EQ(pcd->colors, ply->colors);
  const auto chef = io::read_points(folder / "chef.pcd"), text = io::read_points(folder / "chef_normals.xyz");
  ASSERT_TRUE(chef && text);
  EXPECT_EQ(chef->positions, text->positions);
}

}  // namespace
}  // namespace lodestone
