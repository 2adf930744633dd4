#include "lodestone/core/tangents.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lodestone {
namespace {

// A quad in z = 0 that faces +z, with its texture upright (v downwards, as in glTF) or mirrored.
Mesh quad(bool mirrored) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  AttributeStream normal = make_stream("NORMAL", Semantic::normal, 3, ComponentType::float32, false, 4);
  AttributeStream tangent = make_stream("TANGENT", Semantic::tangent, 4, ComponentType::float32, false, 4);
  AttributeStream uv = make_stream("TEXCOORD_0", Semantic::uv, 2, ComponentType::float32, false, 4);
  for (std::size_t i = 0; i < 4; ++i) std::get<std::vector<float>>(normal.values)[3 * i + 2] = 1;
  auto& values = std::get<std::vector<float>>(uv.values);
  for (std::size_t i = 0; i < 4; ++i) {
    values[2 * i] = mirrored ? 1 - mesh.positions[i].x : mesh.positions[i].x;
    values[2 * i + 1] = 1 - mesh.positions[i].y;
  }
  mesh.attributes = {normal, tangent, uv};
  return mesh;
}

TEST(Tangents, follow_growing_u_with_the_handedness_of_gltf) {
  for (const bool mirrored : {false, true}) {
    Mesh mesh = quad(mirrored);
    rebuild_tangents(mesh);
    const auto& t = std::get<std::vector<float>>(mesh.attributes[1].values);
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_FLOAT_EQ(t[4 * i], mirrored ? -1.0F : 1.0F);
      EXPECT_FLOAT_EQ(t[4 * i + 1], 0);
      EXPECT_FLOAT_EQ(t[4 * i + 2], 0);
      EXPECT_FLOAT_EQ(t[4 * i + 3], mirrored ? -1.0F : 1.0F);
    }
  }
}

TEST(Tangents, stay_where_the_texture_says_nothing) {
  Mesh mesh = quad(false);
  auto& t = std::get<std::vector<float>>(mesh.attributes[1].values);
  for (std::size_t i = 0; i < 4; ++i) t[4 * i + 1] = t[4 * i + 3] = 1;
  for (float& value : std::get<std::vector<float>>(mesh.attributes[2].values)) value = 0.5F;
  const std::vector<float> before = t;
  rebuild_tangents(mesh);
  EXPECT_EQ(t, before);
}

TEST(Tangents, can_be_dropped) {
  Mesh mesh = quad(false);
  drop_tangents(mesh);
  EXPECT_EQ(mesh.attributes.size(), 2U);
  EXPECT_EQ(find_stream(mesh, Semantic::tangent), nullptr);
}

}  // namespace
}  // namespace lodestone
