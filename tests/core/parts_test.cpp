#include "lodestone/core/parts.h"

#include <gtest/gtest.h>

#include "lodestone/core/topology.h"
#include "support/shapes.h"

namespace lodestone {
namespace {

TEST(Parts, are_numbered_by_their_lowest_vertex) {
  const Mesh mesh = test::make_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 0, 0}, {6, 0, 0}, {5, 1, 0}, {9, 9, 9}},
                                    {{4, 5, 3}, {0, 1, 2}, {0, 0, 4}});
  const Parts parts = parts_of(mesh);
  EXPECT_EQ(parts.count, 2U) << "a triangle that uses a vertex twice connects nothing";
  EXPECT_EQ(parts.of_vertex, (std::vector<std::uint32_t>{0, 0, 0, 1, 1, 1, kNone}));
  EXPECT_EQ(parts.of_triangle(mesh, 0), 1U);
}

TEST(Parts, are_the_components_that_topology_counts) {
  for (const test::Shape& shape : test::small_shapes()) {
    const Mesh mesh = shape.make();
    EXPECT_EQ(parts_of(mesh).count, topology_of(mesh).components) << shape.name;
  }
}

}  // namespace
}  // namespace lodestone
