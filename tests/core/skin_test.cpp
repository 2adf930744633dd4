#include "lodestone/core/skin.h"

#include <gtest/gtest.h>

namespace lodestone {
namespace {

// One wedge that eight joints pull at in two sets, and one that a single joint does.
Mesh skinned() {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}};
  for (std::uint32_t set = 0; set < 2; ++set) {
    AttributeStream joints = make_stream("JOINTS", Semantic::joints, 4, ComponentType::uint8, false, 2);
    AttributeStream weights = make_stream("WEIGHTS", Semantic::weights, 4, ComponentType::float32, false, 2);
    joints.set = weights.set = set;
    for (std::uint32_t k = 0; k < 4; ++k) {
      std::get<std::vector<std::uint32_t>>(joints.values)[k] = 10 * set + k;
      std::get<std::vector<float>>(weights.values)[k] = set == 0 ? 0.05F : 0.2F;
    }
    std::get<std::vector<std::uint32_t>>(joints.values)[4] = 7;
    std::get<std::vector<float>>(weights.values)[4] = set == 0 ? 1.0F : 0.0F;
    mesh.attributes.push_back(joints);
    mesh.attributes.push_back(weights);
  }
  return mesh;
}

TEST(Skin, keeps_the_heaviest_influences_and_their_sum) {
  Mesh mesh = skinned();
  EXPECT_EQ(wedges_above(mesh, 4), 1U);
  limit_influences(mesh, 4);
  ASSERT_EQ(mesh.attributes.size(), 2U);  // the second set is empty, and gone
  const auto& joints = std::get<std::vector<std::uint32_t>>(mesh.attributes[0].values);
  const auto& weights = std::get<std::vector<float>>(mesh.attributes[1].values);
  float sum = 0;
  for (std::uint32_t k = 0; k < 4; ++k) {
    EXPECT_EQ(joints[k], 10 + k);
    EXPECT_FLOAT_EQ(weights[k], 0.25F);
    sum += weights[k];
  }
  EXPECT_FLOAT_EQ(sum, 1);
  EXPECT_EQ(joints[4], 7U);
  EXPECT_FLOAT_EQ(weights[4], 1);
  EXPECT_EQ(wedges_above(mesh, 4), 0U);
}

TEST(Skin, leaves_alone_what_has_no_more) {
  Mesh mesh = skinned();
  limit_influences(mesh, 8);
  EXPECT_EQ(mesh.attributes.size(), 4U);
}

}  // namespace
}  // namespace lodestone
