#include "lodestone/core/blend.h"

#include <gtest/gtest.h>

namespace lodestone {
namespace {

template <class T>
AttributeStream stream(const char* name, Semantic semantic, std::uint32_t components, ComponentType type,
                       std::vector<T> values) {
  AttributeStream s = make_stream(name, semantic, components, type, false, 0);
  s.values = std::move(values);
  return s;
}

TEST(Blend, uvs_are_interpolated_normals_stay_unit_ids_are_picked) {
  std::vector<AttributeStream> streams{
      stream<float>("TEXCOORD_0", Semantic::uv, 2, ComponentType::float32, {0, 0, 1, 2}),
      stream<float>("NORMAL", Semantic::normal, 3, ComponentType::float32, {1, 0, 0, 0, 1, 0}),
      stream<std::uint32_t>("id", Semantic::categorical, 1, ComponentType::uint32, {7, 9}),
      stream<double>("depth", Semantic::generic, 1, ComponentType::float64, {10, 20})};
  AttributeBlender(streams).blend(0, 1, 0.25F);
  const auto& uv = std::get<std::vector<float>>(streams[0].values);
  EXPECT_FLOAT_EQ(uv[0], 0.25F);
  EXPECT_FLOAT_EQ(uv[1], 0.5F);
  const auto& n = std::get<std::vector<float>>(streams[1].values);
  EXPECT_NEAR(n[0] * n[0] + n[1] * n[1] + n[2] * n[2], 1, 1e-6);
  EXPECT_EQ(std::get<std::vector<std::uint32_t>>(streams[2].values)[0], 7U);
  EXPECT_DOUBLE_EQ(std::get<std::vector<double>>(streams[3].values)[0], 12.5);
}

TEST(Blend, opposite_normals_do_not_vanish) {
  std::vector<AttributeStream> streams{
      stream<float>("NORMAL", Semantic::normal, 3, ComponentType::float32, {1, 0, 0, -1, 0, 0})};
  AttributeBlender(streams).blend(0, 1, 0.5F);
  EXPECT_FLOAT_EQ(std::get<std::vector<float>>(streams[0].values)[0], 1);
}

TEST(Blend, skin_influences_merge_by_joint_and_keep_their_sum) {
  std::vector<AttributeStream> streams{
      stream<std::uint32_t>("JOINTS_0", Semantic::joints, 4, ComponentType::uint8, {1, 2, 0, 0, 2, 3, 4, 5}),
      stream<float>("WEIGHTS_0", Semantic::weights, 4, ComponentType::float32,
                    {0.5F, 0.5F, 0, 0, 0.4F, 0.3F, 0.2F, 0.1F})};
  AttributeBlender(streams).blend(0, 1, 0.5F);
  const auto& joints = std::get<std::vector<std::uint32_t>>(streams[0].values);
  const auto& weights = std::get<std::vector<float>>(streams[1].values);
  EXPECT_EQ(joints[0], 2U);  // 0.25 + 0.2 is the heaviest
  EXPECT_EQ(joints[1], 1U);
  float sum = 0;
  for (std::size_t k = 0; k < 4; ++k) sum += weights[k];
  EXPECT_NEAR(sum, 1, 1e-6);
  EXPECT_GT(weights[0], weights[1]);
}

}  // namespace
}  // namespace lodestone
