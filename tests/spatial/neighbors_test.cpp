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

}  // namespace
}  // namespace lodestone::spatial
