#include "lodestone/chain/ladder/constraints.h"

#include <gtest/gtest.h>

#include "support/shapes.h"

namespace lodestone::chain {
namespace {

Mesh with_values(Mesh mesh, float value) {
  AttributeStream stream =
      make_stream("importance", Semantic::generic, 1, ComponentType::float32, false, mesh.wedge_count());
  for (float& x : std::get<std::vector<float>>(stream.values)) x = value;
  mesh.attributes.push_back(std::move(stream));
  return mesh;
}

TEST(SimplifyConstraints, nothing_asked_is_nothing_told) {
  const auto told = vertex_constraints(make_model(test::torus(8)), {});
  ASSERT_TRUE(told);
  EXPECT_TRUE(told->at(0).weights.empty());
  EXPECT_TRUE(told->at(0).no_move.empty());
}

TEST(SimplifyConstraints, spheres_are_in_the_scene_where_an_instance_places_the_mesh) {
  Model model = make_model(test::torus(8));
  model.instances[0].transform = Mat4d::translation({100, 0, 0});
  SimplifyConstraints constraints;
  constraints.spheres.push_back({{100, 0, 0}, 50, 7, false});
  const auto near = vertex_constraints(model, constraints);
  ASSERT_TRUE(near);
  for (const float w : near->at(0).weights) EXPECT_EQ(w, 7);
  constraints.spheres[0].center = {0, 0, 0};
  const auto far = vertex_constraints(model, constraints);
  ASSERT_TRUE(far);
  for (const float w : far->at(0).weights) EXPECT_EQ(w, 1);
  constraints.spheres[0] = {{100, 0, 0}, 50, 1, true};
  const auto locked = vertex_constraints(model, constraints);
  ASSERT_TRUE(locked);
  for (const std::uint8_t l : locked->at(0).no_move) EXPECT_EQ(l, 1);
}

TEST(SimplifyConstraints, attributes_give_weights_or_say_what_there_is) {
  const Model model = make_model(with_values(test::torus(8), 3));
  SimplifyConstraints constraints;
  constraints.weight_attribute = "importance";
  const auto told = vertex_constraints(model, constraints);
  ASSERT_TRUE(told);
  for (const float w : told->at(0).weights) EXPECT_EQ(w, 3);
  constraints.weight_attribute = "depth";
  const auto missing = vertex_constraints(model, constraints);
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().remedy.find("importance"), std::string::npos);
  constraints.weight_attribute = "importance";
  EXPECT_FALSE(vertex_constraints(make_model(with_values(test::torus(8), -1)), constraints));
}

TEST(SimplifyConstraints, spheres_that_hold_nothing_are_named) {
  Model model = make_model(test::torus(8));
  model.instances[0].transform = Mat4d::translation({100, 0, 0});
  const std::vector<ConstraintSphere> spheres{
      {{0, 0, 0}, 5, 2, false}, {{100, 0, 0}, 5, 2, false}, {{7, 0, 0}, 1, 1, true}};
  EXPECT_EQ(empty_spheres(model, spheres), (std::vector<std::size_t>{0, 2}));
  EXPECT_TRUE(empty_spheres(model, {}).empty());
}

TEST(SimplifyConstraints, triangles_are_counted_over_all_meshes) {
  Model model = make_model(test::tetrahedron());
  model.meshes.push_back(test::cube());
  SimplifyConstraints constraints;
  EXPECT_TRUE(untouched_triangles(model, constraints)->empty());
  constraints.only = {{3, 5}, {15, 15}};
  const auto r = untouched_triangles(model, constraints);
  ASSERT_TRUE(r);
  EXPECT_EQ(r->at(0), (std::vector<std::uint8_t>{1, 1, 1, 0}));
  EXPECT_EQ(r->at(1), (std::vector<std::uint8_t>{0, 0, 1, 1, 1, 1, 1, 1, 1, 1, 1, 0}));
  const auto told = vertex_constraints(model, constraints);
  ASSERT_TRUE(told);
  EXPECT_EQ(told->at(0).no_move, (std::vector<std::uint8_t>{1, 1, 1, 1}));
  constraints.only = {{0, 16}};
  EXPECT_EQ(untouched_triangles(model, constraints).error().code, ErrorCode::bad_argument);
  constraints.only = {{2, 1}};
  EXPECT_EQ(vertex_constraints(model, constraints).error().code, ErrorCode::bad_argument);
}

}  // namespace
}  // namespace lodestone::chain
