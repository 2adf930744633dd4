#include "lodestone/measure/shape.h"

#include <gtest/gtest.h>

#include "support/shapes.h"

namespace lodestone::measure {
namespace {

Shape shape_of_mesh(const Mesh& mesh) { return *shape_of(make_model(mesh)); }

TEST(Shape, cube_torus_and_sphere) {
  const Shape cube = shape_of_mesh(test::cube());
  EXPECT_DOUBLE_EQ(cube.area, 6);
  EXPECT_DOUBLE_EQ(cube.volume, 1);
  EXPECT_EQ(cube.genus, 0);
  EXPECT_EQ(shape_of_mesh(test::torus(12)).genus, 1);
  EXPECT_EQ(shape_of_mesh(test::sphere(8)).genus, 0);
}

TEST(Shape, what_is_open_or_not_manifold_has_no_genus) {
  EXPECT_FALSE(shape_of_mesh(test::grid(3)).genus);
  EXPECT_FALSE(shape_of_mesh(test::moebius(9)).genus);
  EXPECT_FALSE(shape_of_mesh(test::three_faces_on_an_edge()).genus);
}

// Two tori and a mirrored third: areas and handles add up, and a mirror does not turn the volume.
TEST(Shape, instances_count_as_drawn) {
  Model model = make_model(test::torus(12));
  const Shape one = *shape_of(model);
  Instance second = model.instances.front(), mirrored = second;
  second.transform = second.transform * Mat4d::translation({10, 0, 0});
  mirrored.transform = mirrored.transform * Mat4d::scale({-1, 1, 1});
  model.instances.push_back(second);
  model.instances.push_back(mirrored);
  const Shape three = *shape_of(model);
  EXPECT_EQ(three.topology.components, 3U);
  EXPECT_EQ(three.genus, 3);
  EXPECT_NEAR(three.area, 3 * one.area, 1e-9);
  EXPECT_NEAR(three.volume, 3 * one.volume, 1e-9);
}

}  // namespace
}  // namespace lodestone::measure
