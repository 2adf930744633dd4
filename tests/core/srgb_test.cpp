#include "lodestone/core/srgb.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace lodestone {
namespace {

TEST(Srgb, light_is_the_standard_formula) {
  for (int i = 0; i <= 1000; ++i) {
    const double c = i / 1000.0;
    EXPECT_NEAR(light_of_srgb(c), c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4), 1e-14);
  }
}

TEST(Srgb, bytes_come_back_and_lights_between_them_go_to_the_nearer) {
  for (int i = 0; i < 256; ++i) {
    EXPECT_EQ(byte_of_light(light_of_byte(static_cast<std::uint8_t>(i))), i);
    if (i == 255) break;
    EXPECT_EQ(byte_of_light(light_of_srgb((i + 0.49) / 255)), i);
    EXPECT_EQ(byte_of_light(light_of_srgb((i + 0.51) / 255)), i + 1);
  }
}

TEST(Srgb, what_is_no_light_is_cut) {
  EXPECT_EQ(byte_of_light(-1), 0);
  EXPECT_EQ(byte_of_light(7), 255);
  EXPECT_EQ(byte_of_light(std::numeric_limits<double>::infinity()), 255);
  EXPECT_EQ(byte_of_light(std::numeric_limits<double>::quiet_NaN()), 0);
}

}  // namespace
}  // namespace lodestone
