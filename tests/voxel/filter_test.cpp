#include "lodestone/voxel/filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

namespace lodestone::voxel {
namespace {

ScalarVolume<float> spike(std::uint32_t n) {
  ScalarVolume<float> out;
  out.grid.size = {n, n, n};
  out.values.assign(std::size_t{n} * n * n, 0.0F);
  out.values[out.index(n / 2, n / 2, n / 2)] = 1;
  return out;
}

TEST(Gaussian, spreads_a_spike_by_its_deviation) {
  const auto blurred = gaussian(spike(33), {2, 3, 0});
  ASSERT_TRUE(blurred);
  double sum = 0, x2 = 0, y2 = 0, z2 = 0;
  for (std::uint32_t z = 0; z < 33; ++z) {
    for (std::uint32_t y = 0; y < 33; ++y) {
      for (std::uint32_t x = 0; x < 33; ++x) {
        const double v = blurred->at(x, y, z);
        sum += v;
        x2 += v * (x - 16.0) * (x - 16.0);
        y2 += v * (y - 16.0) * (y - 16.0);
        z2 += v * (z - 16.0) * (z - 16.0);
      }
    }
  }
  EXPECT_NEAR(sum, 1, 1e-5);
  EXPECT_NEAR(std::sqrt(x2), 2, 0.05);
  EXPECT_NEAR(std::sqrt(y2), 3, 0.08);
  EXPECT_EQ(z2, 0);
}

TEST(Gaussian, leaves_a_constant_volume_alone_up_to_its_border) {
  ScalarVolume<float> flat;
  flat.grid.size = {5, 4, 3};
  flat.values.assign(60, 7.0F);
  const auto blurred = gaussian(flat, {3, 3, 3});
  ASSERT_TRUE(blurred);
  for (const float v : blurred->values) EXPECT_NEAR(v, 7, 1e-4);
  EXPECT_FALSE(gaussian(flat, {-1, 0, 0}));
  EXPECT_FALSE(gaussian(flat, {std::nan(""), 0, 0}));
}

TEST(Gaussian, of_next_to_nothing_leaves_values_as_they_are) {
  ScalarVolume<float> volume;
  volume.grid.size = {3, 3, 3};
  for (int i = 0; i < 27; ++i) volume.values.push_back(static_cast<float>(i));
  for (const double sigma : {1e-300, 1e-9, 0.009, 0.02}) {
    const auto blurred = gaussian(volume, {sigma, sigma, sigma});
    ASSERT_TRUE(blurred);
    EXPECT_EQ(blurred->values, volume.values) << sigma;
  }
}

TEST(Median, takes_speckles_away_and_keeps_edges) {
  ScalarVolume<std::int16_t> volume;
  volume.grid.size = {8, 8, 8};
  volume.values.resize(512);
  for (std::uint32_t z = 0; z < 8; ++z) {
    for (std::uint32_t y = 0; y < 8; ++y) {
      for (std::uint32_t x = 0; x < 8; ++x) volume.values[volume.index(x, y, z)] = x < 4 ? -100 : 900;
    }
  }
  volume.values[volume.index(1, 3, 3)] = 30'000;  // a speckle
  const auto filtered = median(volume, 1);
  ASSERT_TRUE(filtered);
  for (std::uint32_t x = 0; x < 8; ++x) EXPECT_EQ(filtered->at(x, 3, 3), x < 4 ? -100 : 900) << x;
  EXPECT_FALSE(median(volume, 0));
  EXPECT_FALSE(median(volume, 8));
}

TEST(Median, of_values_that_are_no_numbers) {
  ScalarVolume<float> volume;
  volume.grid.size = {3, 3, 3};
  volume.values.assign(27, std::numeric_limits<float>::quiet_NaN());
  volume.values[13] = 1;
  const auto filtered = median(volume, 1);
  ASSERT_TRUE(filtered);
  for (const float v : filtered->values) EXPECT_EQ(v, std::numeric_limits<float>::lowest());
}

}  // namespace
}  // namespace lodestone::voxel
