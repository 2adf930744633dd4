#include "lodestone/voxel/resample.h"

#include <gtest/gtest.h>

#include <random>

namespace lodestone::voxel {
namespace {

BitVolume noise(std::array<std::uint32_t, 3> size, unsigned seed) {
  BitVolume out({size, {1, 2, 3}, {0.5, 1, 2}});
  std::mt19937 random(seed);
  for (std::uint32_t z = 0; z < size[2]; ++z) {
    for (std::uint32_t y = 0; y < size[1]; ++y) {
      for (std::uint32_t x = 0; x < size[0]; ++x) {
        if (random() % 3 == 0) out.set(x, y, z);
      }
    }
  }
  return out;
}

TEST(VoxelValue, is_the_voxel_at_its_centre_and_linear_between) {
  const BitVolume volume = noise({9, 8, 7}, 1);
  for (std::uint32_t z = 0; z + 1 < 7; ++z) {
    for (std::uint32_t y = 0; y + 1 < 8; ++y) {
      for (std::uint32_t x = 0; x + 1 < 9; ++x) {
        const auto bit = [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
          return volume.at(x + i, y + j, z + k) ? 1.0 : 0.0;
        };
        EXPECT_EQ(voxel_value(volume, {1.0 * x, 1.0 * y, 1.0 * z}), bit(0, 0, 0));
        // Equation 2-14 written out.
        const double u = 0.25, v = 0.5, w = 0.125;
        const double want = (1 - u) * (1 - v) * (1 - w) * bit(0, 0, 0) + u * (1 - v) * (1 - w) * bit(1, 0, 0) +
                            (1 - u) * (1 - v) * w * bit(0, 0, 1) + u * (1 - v) * w * bit(1, 0, 1) +
                            (1 - u) * v * (1 - w) * bit(0, 1, 0) + u * v * (1 - w) * bit(1, 1, 0) +
                            (1 - u) * v * w * bit(0, 1, 1) + u * v * w * bit(1, 1, 1);
        EXPECT_NEAR(voxel_value(volume, {x + u, y + v, z + w}), want, 1e-12);
      }
    }
  }
  EXPECT_EQ(voxel_value(volume, {-1, 0, 0}), 0);
  EXPECT_EQ(voxel_value(volume, {0, 1e30, 0}), 0);
}

TEST(Downsample, counts_every_voxel_once) {
  const BitVolume volume = noise({130, 21, 17}, 2);
  for (const std::array<std::uint32_t, 3>& size :
       {std::array<std::uint32_t, 3>{130, 21, 17}, {65, 7, 17}, {33, 10, 5}, {1, 1, 1}}) {
    const auto small = downsample(volume, size);
    ASSERT_TRUE(small);
    for (std::uint32_t z = 0; z < size[2]; ++z) {
      for (std::uint32_t y = 0; y < size[1]; ++y) {
        for (std::uint32_t x = 0; x < size[0]; ++x) {
          std::uint32_t set = 0, all = 0;
          for (std::uint32_t k = z * 17 / size[2]; k < (z + 1) * 17 / size[2]; ++k) {
            for (std::uint32_t j = y * 21 / size[1]; j < (y + 1) * 21 / size[1]; ++j) {
              for (std::uint32_t i = x * 130 / size[0]; i < (x + 1) * 130 / size[0]; ++i) {
                ++all;
                set += volume.at(i, j, k) ? 1U : 0U;
              }
            }
          }
          ASSERT_NEAR(small->at(x, y, z), 255.0 * set / all, 0.501);
        }
      }
    }
    EXPECT_NEAR(small->grid.spacing.x * size[0], 65, 1e-9);
  }
  EXPECT_EQ(downsample(volume, {131, 1, 1}).error().code, ErrorCode::bad_argument);
  EXPECT_EQ(downsample(volume, {0, 1, 1}).error().code, ErrorCode::bad_argument);
}

}  // namespace
}  // namespace lodestone::voxel
