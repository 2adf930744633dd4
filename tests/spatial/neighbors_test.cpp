#include "lodestone/spatial/neighbors.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/shapes.h"

namespace lodestone::spatial {
namespace {

TEST(Neighbors, meet_at_the_side_that_both_have) {
  for (const test::Shape& shape : test::small_shapes()) {
    const auto surface = flatten(make_model(shape.make()));
    if (!surface) continue;
    const auto neighbors = triangle_neighbors(*surface);
    for (std::uint32_t t = 0; t < neighbors.size(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (neighbors[t][k] == kNone) continue;
        const Triangle &v = surface->triangles[t], &w = surface->triangles[neighbors[t][k]];
        EXPECT_TRUE(std::count(w.begin(), w.end(), v[k]) == 1 && std::count(w.begin(), w.end(), v[(k + 1) % 3]) == 1)
            << shape.name;
        const auto& back = neighbors[neighbors[t][k]];
        EXPECT_NE(std::find(back.begin(), back.end(), t), back.end()) << shape.name;
      }
    }
  }
}

TEST(Neighbors, closed_meshes_have_three_and_fans_of_three_none) {
  for (const auto& n : triangle_neighbors(*flatten(make_model(test::torus(9)))))
    EXPECT_EQ(std::count(n.begin(), n.end(), kNone), 0);
  for (const auto& n : triangle_neighbors(*flatten(make_model(test::three_faces_on_an_edge()))))
    EXPECT_EQ(std::count(n.begin(), n.end(), kNone), 3);
}

// Where both walk their side the same way the surface has no side to be on.
TEST(Neighbors, turned_triangles_have_none_across_the_turn) {
  const Mesh same = test::make_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {1, 3, 2}});
  const Mesh turned = test::make_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {3, 1, 2}});
  const auto joined = [](const Mesh& mesh) {
    std::size_t count = 0;
    for (const auto& n : triangle_neighbors(*flatten(make_model(mesh)))) {
      count += static_cast<std::size_t>(3 - std::count(n.begin(), n.end(), kNone));
    }
    return count;
  };
  EXPECT_EQ(joined(same), 2U);
  EXPECT_EQ(joined(turned), 0U);
}

}  // namespace
}  // namespace lodestone::spatial
