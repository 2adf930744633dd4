#include "lodestone/voxel/cube_cases_detail.h"

#include <gtest/gtest.h>

#include <map>

#include "lodestone/math/vec.h"

namespace lodestone::voxel::detail {
namespace {

Vec3d corner(unsigned c) { return {double(c & 1), double(c >> 1 & 1), double(c >> 2 & 1)}; }

Vec3d middle(std::uint8_t e) {
  const Vec3d low = corner(kEdgeCorner[e]);
  return (low + corner(kEdgeCorner[e] | 1U << (e / 4))) * 0.5;
}

TEST(CubeCases, as_many_triangles_as_others_have) {
  std::size_t sum = 0;
  for (const CubeCase& one : cube_cases()) sum += one.triangles;
  EXPECT_EQ(sum, 820U);
}

TEST(CubeCases, faces_look_away_from_a_single_inside_corner) {
  for (unsigned c = 0; c < 8; ++c) {
    const CubeCase& one = cube_cases()[1U << c];
    ASSERT_EQ(one.triangles, 1);
    const Vec3d a = middle(one.edges[0][0]), b = middle(one.edges[0][1]), d = middle(one.edges[0][2]);
    EXPECT_GT(dot(cross(b - a, d - a), a - corner(c)), 0);
  }
}

// Sides of triangles in a face are those of its lines, once each; all others are shared by two triangles, in opposite
// directions. The neighbour across the face has the same lines the other way.
TEST(CubeCases, neighbours_fit_together) {
  const auto lines_in_face = [](unsigned inside, unsigned axis, double at) {
    std::map<std::pair<std::pair<double, double>, std::pair<double, double>>, int> lines;
    const CubeCase& one = cube_cases()[inside];
    std::map<std::pair<int, int>, int> sides;
    for (std::size_t t = 0; t < one.triangles; ++t) {
      for (std::size_t k = 0; k < 3; ++k) ++sides[{one.edges[t][k], one.edges[t][(k + 1) % 3]}];
    }
    for (const auto& [side, count] : sides) {
      EXPECT_EQ(count, 1) << inside;
      if (sides.contains({side.second, side.first})) continue;
      const Vec3d a = middle(static_cast<std::uint8_t>(side.first)), b = middle(static_cast<std::uint8_t>(side.second));
      if (a[axis] != at || b[axis] != at) continue;
      const auto flat = [&](Vec3d p) { return std::pair{p[(axis + 1) % 3], p[(axis + 2) % 3]}; };
      ++lines[{flat(a), flat(b)}];
    }
    return lines;
  };
  for (unsigned axis = 0; axis < 3; ++axis) {
    for (unsigned left = 0; left < 256; ++left) {
      for (unsigned right = 0; right < 256; ++right) {
        bool fits = true;
        for (unsigned c = 0; c < 8; ++c) {
          if ((c >> axis & 1) == 0) fits = fits && ((left >> (c | 1U << axis) & 1) == (right >> c & 1));
        }
        if (!fits) continue;
        auto mine = lines_in_face(left, axis, 1);
        for (const auto& [line, count] : lines_in_face(right, axis, 0)) {
          const auto other = mine.find({line.second, line.first});
          ASSERT_TRUE(other != mine.end() && other->second == count) << axis << ' ' << left << ' ' << right;
          mine.erase(other);
        }
        ASSERT_TRUE(mine.empty()) << axis << ' ' << left << ' ' << right;
      }
    }
  }
}

}  // namespace
}  // namespace lodestone::voxel::detail
