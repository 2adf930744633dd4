#include "lodestone/io/points/read.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "io/points/files.h"
#include "lodestone/base/random.h"

namespace lodestone::io {
namespace {

using Color = std::array<std::uint8_t, 4>;

Result<PointCloud> read(const std::string& bytes, const std::string& name) {
  return read_points(std::as_bytes(std::span(bytes)), name);
}

ErrorCode code_of(const std::string& bytes, const std::string& name) {
  const auto cloud = read(bytes, name);
  EXPECT_FALSE(cloud) << name;
  if (cloud) return ErrorCode::cancelled;
  EXPECT_NE(cloud.error().line().find(name), std::string::npos) << "names the file: " << cloud.error().line();
  return cloud.error().code;
}

// What every reader promises, whatever the bytes.
void expect_sound(const PointCloud& cloud) {
  ASSERT_GT(cloud.size(), 0U);
  ASSERT_LE(cloud.size(), cloud.file_points);
  ASSERT_TRUE(cloud.normals.empty() || cloud.normals.size() == cloud.size());
  ASSERT_TRUE(cloud.colors.empty() || cloud.colors.size() == cloud.size());
  for (const Vec3f& p : cloud.positions) ASSERT_TRUE(is_finite(p));
  for (const Vec3f& n : cloud.normals) ASSERT_TRUE(n == Vec3f{} || std::abs(length(n) - 1) < 1e-5F);
}

TEST(Points, text_with_normals_and_colors) {
  const auto cloud = read("1 2 3 0 0 2\n4 5 6 1 0 0\n", "a.xyz");  // (0, 0, 2) is no unit vector
  ASSERT_TRUE(cloud);
  EXPECT_TRUE(cloud->normals.empty());
  const auto normals = read("# scanned\n1 2 3 0 0 1\n\n 4 5 6 -1 0 0\n7 8 9 0 0 0", "a.xyz");
  ASSERT_TRUE(normals);
  EXPECT_EQ(normals->size(), 3U);
  EXPECT_EQ(normals->normals[1], (Vec3f{-1, 0, 0}));
  EXPECT_EQ(normals->normals[2], (Vec3f{0, 0, 0}));
  EXPECT_EQ(normals->warnings.size(), 1U) << "one normal is zero";
  const auto colors = read("x,y,z,r,g,b\n1,2,3,255,0,7\n4,5,6,1,2,3\n", "a.csv");
  ASSERT_TRUE(colors);
  EXPECT_EQ(colors->colors[0], (Color{255, 0, 7, 255}));
  const auto both = read("1;2;3;0;1;0;9;8;7\n", "a.txt");
  ASSERT_TRUE(both);
  EXPECT_EQ(both->normals[0], (Vec3f{0, 1, 0}));
  EXPECT_EQ(both->colors[0], (Color{9, 8, 7, 255}));
  const auto pts = read("2\n1 2 3 -500 10 20 30\n4 5 6 -300 40 50 60\n", "a.pts");
  ASSERT_TRUE(pts);
  EXPECT_EQ(pts->colors[1], (Color{40, 50, 60, 255}));
  EXPECT_EQ(pts->warnings.size(), 1U) << "intensity is left out";
}

TEST(Points, text_that_is_none) {
  EXPECT_EQ(code_of("1 2\n", "a.xyz"), ErrorCode::bad_format);
  EXPECT_EQ(code_of("1 2 3\n4 5\n", "a.xyz"), ErrorCode::bad_format);
  EXPECT_EQ(code_of("1 2 3\n4 5 six\n", "a.xyz"), ErrorCode::bad_format);
  EXPECT_EQ(code_of("once upon a time\nthere was a file\n", "a.txt"), ErrorCode::bad_format);
  EXPECT_EQ(code_of("# nothing\n", "a.xyz"), ErrorCode::empty);
  EXPECT_EQ(code_of("nan 1 2\n", "a.xyz"), ErrorCode::empty);
  EXPECT_EQ(read("1 2 3\n4 5\n", "a.xyz").error().line().substr(0, 8), "a.xyz:2:");
  EXPECT_EQ(code_of("1 2 3\n", "a.foo"), ErrorCode::unsupported);
}

TEST(Points, not_finite_ones_are_left_out_and_told) {
  const auto cloud = read("1 2 3\nnan 0 0\n0 inf 0\n1e300 0 0\n4 5 6\n", "a.xyz");
  ASSERT_TRUE(cloud);
  EXPECT_EQ(cloud->size(), 2U);
  EXPECT_EQ(cloud->file_points, 5U);
  ASSERT_EQ(cloud->warnings.size(), 1U);
  EXPECT_NE(cloud->warnings[0].find("3 points"), std::string::npos);
}

TEST(Points, far_from_the_origin_keep_their_places) {
  const auto cloud = read("500000.25 4000000.125 7\n500001.5 4000000.375 8\n", "a.xyz");
  ASSERT_TRUE(cloud);
  EXPECT_EQ(cloud->position(0), (Vec3d{500000.25, 4000000.125, 7}));
  EXPECT_EQ(cloud->position(1), (Vec3d{500001.5, 4000000.375, 8}));
}

TEST(Points, ply) {
  const std::string text =
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
      "property float nx\nproperty float ny\nproperty float nz\nproperty uchar red\nproperty uchar green\n"
      "property uchar blue\nproperty float quality\nend_header\n1 2 3 0 0 1 255 128 0 5\n4 5 6 0 3 4 1 2 3 5\n";
  const auto cloud = read(text, "a.ply");
  ASSERT_TRUE(cloud);
  EXPECT_EQ(cloud->positions, (std::vector<Vec3f>{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_EQ(cloud->colors, (std::vector<Color>{{255, 128, 0, 255}, {1, 2, 3, 255}}));
  EXPECT_NEAR(cloud->normals[1].y, 0.6F, 1e-6F);
  ASSERT_EQ(cloud->warnings.size(), 1U);
  EXPECT_EQ(cloud->warnings[0], "left out: 'quality'");
  std::string binary =
      "ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty double x\nproperty double y\n"
      "property double z\nproperty ushort red\nproperty ushort green\nproperty ushort blue\nend_header\n";
  for (const double x : {500000.5, 1.0, 2.0}) test::put(binary, x);
  for (int i = 0; i < 3; ++i) test::put(binary, std::uint16_t{65535});
  for (const double x : {500001.5, 1.0, 2.0}) test::put(binary, x);
  for (int i = 0; i < 3; ++i) test::put(binary, std::uint16_t{257});
  const auto wide = read(binary, "a.ply");
  ASSERT_TRUE(wide);
  EXPECT_EQ(wide->position(1).x, 500001.5);
  EXPECT_EQ(wide->colors, (std::vector<Color>{{255, 255, 255, 255}, {1, 1, 1, 255}}));
  EXPECT_EQ(code_of("ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\n"
                    "end_header\n",
                    "a.ply"),
            ErrorCode::empty);
  EXPECT_EQ(code_of(binary.substr(0, binary.size() - 1), "a.ply"), ErrorCode::bad_format);
}

TEST(Points, pcd_in_all_codings) {
  for (const std::string data : {"ascii", "binary", "binary_compressed"}) {
    SCOPED_TRACE(data);
    const auto cloud = read(test::pcd(100, data), "a.pcd");
    ASSERT_TRUE(cloud) << cloud.error().line();
    ASSERT_EQ(cloud->size(), 100U);
    EXPECT_EQ(cloud->positions[9], (Vec3f{9, 9.5F, -9}));
    EXPECT_EQ(cloud->normals[9], (Vec3f{0, 0, -1}));
    EXPECT_EQ(cloud->colors[99], (Color{16, 32, 48, 200}));
    EXPECT_TRUE(cloud->warnings.empty());
  }
}

TEST(Points, pcd_of_other_fields) {
  const std::string head =
      "VERSION .7\nFIELDS X Y Z rgb _ Intensity\nSIZE 8 8 8 4 1 2\nTYPE F F F F U U\nCOUNT 1 1 1 1 3 1\n";
  std::string body;
  for (const double x : {1.0, 2.0, 3.0}) test::put(body, x);
  test::put(body, std::uint32_t{0x00FF8001});
  body += "abcde";
  const auto cloud = read(head + "WIDTH 1\nHEIGHT 1\nDATA binary\n" + body, "a.pcd");  // no POINTS
  ASSERT_TRUE(cloud) << cloud.error().line();
  EXPECT_EQ(cloud->positions[0], (Vec3f{1, 2, 3}));
  EXPECT_EQ(cloud->colors[0], (Color{255, 128, 1, 255}));
  EXPECT_EQ(cloud->warnings, (std::vector<std::string>{"left out: 'Intensity'"}));
}

TEST(Points, pcd_that_is_none) {
  EXPECT_EQ(code_of("1 2 3\n", "a.pcd"), ErrorCode::bad_format);
  EXPECT_EQ(code_of("VERSION 0.7\n", "a.pcd"), ErrorCode::bad_format);
  EXPECT_EQ(code_of("FIELDS x y\nPOINTS 1\nDATA ascii\n1 2\n", "a.pcd"), ErrorCode::bad_format);
  EXPECT_EQ(code_of("FIELDS x y z\nPOINTS 9999999999\nDATA ascii\n1 2 3\n", "a.pcd"), ErrorCode::bad_format);
  EXPECT_EQ(code_of("FIELDS x y z\nPOINTS 9999999999\nDATA binary\n1 2 3\n", "a.pcd"), ErrorCode::bad_format);
  EXPECT_EQ(code_of("FIELDS x y z\nWIDTH 9999999999\nHEIGHT 9999999999\nDATA binary\n1 2 3\n", "a.pcd"),
            ErrorCode::bad_format);
  EXPECT_EQ(code_of("FIELDS x y z\nSIZE 4 4\nPOINTS 1\nDATA ascii\n1 2 3\n", "a.pcd"), ErrorCode::bad_format);
  EXPECT_EQ(code_of("FIELDS x y z\nSIZE 3 4 4\nPOINTS 1\nDATA binary\n123456789012\n", "a.pcd"),
            ErrorCode::unsupported);
  EXPECT_EQ(code_of("FIELDS x y z\nPOINTS 0\nDATA ascii\n", "a.pcd"), ErrorCode::empty);
  std::string bomb = test::pcd_header(100000000, "binary_compressed");
  test::put(bomb, std::uint32_t{4});
  test::put(bomb, std::uint32_t{2800000000});
  EXPECT_EQ(code_of(bomb + "1234", "a.pcd"), ErrorCode::bad_format);
}

TEST(Points, las_of_all_versions_and_formats) {
  for (unsigned minor = 0; minor <= 4; ++minor) {
    for (unsigned format = 0; format <= 10; ++format) {
      SCOPED_TRACE(std::to_string(minor) + " " + std::to_string(format));
      const auto cloud = read(test::las(minor, format, 50), "a.las");
      ASSERT_TRUE(cloud) << cloud.error().line();
      ASSERT_EQ(cloud->size(), 50U);
      EXPECT_NEAR(cloud->position(7).x, 1000.07, 1e-6);
      EXPECT_NEAR(cloud->position(7).y, 2000, 1e-6);
      EXPECT_NEAR(cloud->position(7).z, -0.07, 1e-6);
      const bool colored = format == 2 || format == 3 || format == 5 || format == 7 || format == 8 || format == 10;
      ASSERT_EQ(cloud->colors.size(), colored ? 50U : 0U);
      if (colored) {
        EXPECT_EQ(cloud->colors[9], (Color{9, 2, 3, 255}));
      }
    }
  }
  EXPECT_EQ(read(test::las(2, 3, 50, 257), "a.las")->colors[9], (Color{9, 2, 3, 255}));
}

TEST(Points, las_that_is_none) {
  const std::string good = test::las(2, 3, 10);
  EXPECT_EQ(code_of("LAS", "a.las"), ErrorCode::bad_format);
  EXPECT_EQ(code_of(good.substr(0, 200), "a.las"), ErrorCode::bad_format);
  EXPECT_EQ(code_of(test::las(2, 3, 0), "a.las"), ErrorCode::empty);
  std::string bad = good;
  bad[104] = static_cast<char>(0x83);
  EXPECT_EQ(code_of(bad, "a.las"), ErrorCode::unsupported);  // LAZ under another name
  bad = good;
  bad[25] = 9;
  EXPECT_EQ(code_of(bad, "a.las"), ErrorCode::unsupported);
  bad = good;
  test::put_at(bad, 105, std::uint16_t{5});
  EXPECT_EQ(code_of(bad, "a.las"), ErrorCode::bad_format);
  bad = good;
  test::put_at(bad, 131, 0.0);
  EXPECT_EQ(code_of(bad, "a.las"), ErrorCode::bad_format);
  bad = good;
  test::put_at(bad, 155, std::nan(""));
  EXPECT_EQ(code_of(bad, "a.las"), ErrorCode::bad_format);
  bad = good;
  test::put_at(bad, 96, std::uint32_t{0xffffffff});
  EXPECT_EQ(code_of(bad, "a.las"), ErrorCode::bad_format);
  const auto laz = read(good, "a.LAZ");
  ASSERT_FALSE(laz);
  EXPECT_NE(laz.error().line().find("pdal translate"), std::string::npos);
}

std::vector<std::pair<std::string, std::string>> small_files() {
  return {{test::pcd(20, "ascii"), "a.pcd"},
          {test::pcd(20, "binary"), "a.pcd"},
          {test::pcd(20, "binary_compressed"), "a.pcd"},
          {test::las(2, 3, 20), "a.las"},
          {test::las(4, 7, 20), "a.las"},
          {"1 2 3 0 0 1 1 2 3\n4 5 6 0 1 0 4 5 6\n", "a.xyz"},
          {"ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
           "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n1 2 3 4 5 6\n4 5 6 7 8 9\n",
           "a.ply"}};
}

TEST(Points, cut_off_anywhere_end_in_an_error_or_in_fewer) {
  for (const auto& [bytes, name] : small_files()) {
    SCOPED_TRACE(name);
    const auto whole = read(bytes, name);
    ASSERT_TRUE(whole);
    const bool is_text = bytes.find("binary") == std::string::npos && name != "a.las";
    for (std::size_t n = 0; n < bytes.size(); ++n) {
      const auto part = read(bytes.substr(0, n), name);
      if (!part) continue;
      ASSERT_TRUE(is_text) << n;
      expect_sound(*part);
      ASSERT_LE(part->size(), whole->size());
    }
  }
}

TEST(Points, flipped_bytes_end) {
  std::uint64_t counter = 0;
  for (const auto& [bytes, name] : small_files()) {
    SCOPED_TRACE(name);
    for (int round = 0; round < 4000; ++round) {
      std::string damaged = bytes;
      const std::uint64_t flips = 1 + random_bits(1, counter++) % 4;
      for (std::uint64_t f = 0; f < flips; ++f) {
        const std::uint64_t at = random_bits(2, counter++) % damaged.size();
        damaged[at] = static_cast<char>(random_bits(3, counter++));
      }
      const auto cloud = read(damaged, name);
      if (cloud) expect_sound(*cloud);
    }
  }
}

TEST(Points, what_looks_like_them) {
  const std::string cloud = "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nend_header\n";
  const std::string no_faces = "ply\r\nformat ascii 1.0\r\nelement vertex 2\r\nelement face 0\r\nend_header\r\n";
  const std::string mesh = "ply\nformat ascii 1.0\nelement vertex 2\nelement face 7\nend_header\n";
  EXPECT_TRUE(looks_like_points("a.ply", cloud));
  EXPECT_TRUE(looks_like_points("A.PLY", no_faces));
  EXPECT_FALSE(looks_like_points("a.ply", mesh));
  EXPECT_FALSE(looks_like_points("a.ply", cloud.substr(0, 40)));
  EXPECT_FALSE(looks_like_points("a.ply", "element vertex 2\nend_header\n"));
  for (const char* name : {"a.xyz", "a.pcd", "a.LAS", "a.pts", "a.laz"}) EXPECT_TRUE(looks_like_points(name, ""));
  for (const char* name : {"a.obj", "a.glb", "a", "a.stl"}) EXPECT_FALSE(looks_like_points(name, ""));
}

TEST(Points, from_a_file) {
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "points_test.xyz";
  std::ofstream(path) << "1 2 3\n4 5 6\n";
  const auto cloud = read_points(path);
  ASSERT_TRUE(cloud);
  EXPECT_EQ(cloud->size(), 2U);
  const Task task = Task::root({}, 1);
  task.cancel();
  EXPECT_EQ(read_points(path, task).error().code, ErrorCode::cancelled);
  std::filesystem::remove(path);
  EXPECT_EQ(read_points(path).error().code, ErrorCode::cannot_read);
}

}  // namespace
}  // namespace lodestone::io
