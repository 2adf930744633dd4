#include "lodestone/spatial/self_intersections.h"

#include <gtest/gtest.h>

#include "lodestone/core/model.h"
#include "support/shapes.h"

namespace lodestone::spatial {
namespace {

using Corners = std::array<Vec3d, 3>;

TEST(SelfIntersections, of_two_triangles) {
  const Corners flat{Vec3d{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
  struct Row {
    const char* what;
    Corners other;
    bool crosses;
  };
  const Row rows[] = {
      {"a side goes through", {Vec3d{1, 1, -1}, {1, 1, 1}, {1, 9, 1}}, true},
      {"a corner goes through", {Vec3d{1, 1, -1}, {1, 2, 1}, {2, 1, 1}}, true},
      {"the first one's side goes through the other", {Vec3d{2, -1, -1}, {2, -1, 9}, {2, 9, -1}}, true},
      {"beside", {Vec3d{5, 5, -1}, {5, 5, 1}, {5, 9, 1}}, false},
      {"above", {Vec3d{1, 1, 0.5}, {1, 2, 1}, {2, 1, 1}}, false},
      {"touches with a corner", {Vec3d{1, 1, 0}, {1, 2, 1}, {2, 1, 1}}, false},
      {"lies in the same plane", {Vec3d{1, 1, 0}, {5, 1, 0}, {1, 5, 0}}, false},
      {"without area", {Vec3d{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, false},
  };
  for (const Row& row : rows) {
    EXPECT_EQ(triangles_intersect(flat, row.other), row.crosses) << row.what;
    EXPECT_EQ(triangles_intersect(row.other, flat), row.crosses) << row.what;
  }
}

TEST(SelfIntersections, of_a_soup_are_those_that_brute_force_finds) {
  const Mesh mesh = test::soup(3, 150, 300);
  const Surface surface = *flatten(make_model(mesh), {});
  const Bvh tree(surface);
  std::vector<std::array<std::uint32_t, 2>> all, of_some;
  std::vector<std::uint8_t> wanted(surface.triangles.size(), 0);
  for (std::size_t t = 0; t < wanted.size(); t += 3) wanted[t] = 1;
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
    for (std::uint32_t u = t + 1; u < surface.triangles.size(); ++u) {
      bool joined = false;
      for (const std::uint32_t v : surface.triangles[t]) {
        for (const std::uint32_t w : surface.triangles[u]) joined = joined || v == w;
      }
      if (joined || !triangles_intersect(surface.corners(t), surface.corners(u))) continue;
      all.push_back({t, u});
      if (wanted[t] != 0 || wanted[u] != 0) of_some.push_back({t, u});
    }
  }
  EXPECT_GT(all.size(), 20U);
  EXPECT_EQ(self_intersections(tree, {}, {}), all);
  EXPECT_EQ(self_intersections(tree, wanted, {}), of_some);
}

TEST(SelfIntersections, of_a_clean_surface_are_none) {
  const Surface surface = *flatten(make_model(test::sphere(30)), {});
  EXPECT_TRUE(self_intersections(Bvh(surface), {}, {}).empty());
}

TEST(Folds, are_edges_where_triangles_lie_on_each_other) {
  for (const float lift : {0.0F, 0.1F, 0.3F}) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0.5F, 1, 0}, {0.5F, 1, lift}};
    mesh.triangles = {{0, 1, 2}, {1, 0, 3}};
    const Surface surface = *flatten(make_model(std::move(mesh)), {});
    EXPECT_EQ(folds(surface).size(), lift < 0.17F ? 1U : 0U) << lift;
  }
  EXPECT_TRUE(folds(*flatten(make_model(test::cube()), {})).empty());
}

}  // namespace
}  // namespace lodestone::spatial
