#include "lodestone/report/svg_plot.h"

#include <gtest/gtest.h>

#include <limits>

namespace lodestone::report {
namespace {

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

TEST(AxisTicks, round_steps) {
  EXPECT_EQ(axis_ticks(0, 10, false), (std::vector<double>{0, 2, 4, 6, 8, 10}));
  EXPECT_EQ(axis_ticks(0, 0.5, false).size(), 6U);
  EXPECT_EQ(axis_ticks(1, 1000, true), (std::vector<double>{1, 10, 100, 1000}));
  const std::vector<double> near = axis_ticks(9000, 260'000, true);
  EXPECT_EQ(near, (std::vector<double>{10'000, 20'000, 50'000, 100'000, 200'000}));
  EXPECT_GE(axis_ticks(138'000, 247'000, true).size(), 2U);  // no power, half or fifth of one but 200,000
  EXPECT_LE(axis_ticks(1e-30, 1e30, true).size(), 8U);
}

TEST(AxisTicks, ranges_that_are_none) {
  EXPECT_TRUE(axis_ticks(0, 10, true).empty());
  EXPECT_TRUE(axis_ticks(3, 3, false).empty());
  EXPECT_TRUE(axis_ticks(1, std::numeric_limits<double>::infinity(), true).empty());
  EXPECT_TRUE(axis_ticks(0, std::numeric_limits<double>::quiet_NaN(), false).empty());
}

TEST(SvgPlot, a_dot_a_point_that_can_be_shown) {
  Plot plot{"Title <1>", "x (m)", "y", true, true, {{"a & b", {{1, 2}, {10, 0}, {100, 3}}, "", false}}};
  const std::string svg = svg_of(plot);
  EXPECT_EQ(count(svg, "<circle"), 2U);
  EXPECT_NE(svg.find("<title>Title &lt;1&gt;</title>"), std::string::npos);
  EXPECT_NE(svg.find("a &amp; b"), std::string::npos);
  EXPECT_NE(svg.find("x (m)"), std::string::npos);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

TEST(SvgPlot, empty_single_and_constant_lines) {
  for (const bool logarithmic : {false, true}) {
    for (const std::vector<Vec2d>& points : {std::vector<Vec2d>{}, {{5, 5}}, {{5, 7}, {6, 7}}, {{0, 0}}, {{-1, -2}}}) {
      const std::string svg = svg_of({"t", "x", "y", logarithmic, logarithmic, {{"l", points, "", false}}});
      EXPECT_EQ(svg.find("nan"), std::string::npos);
      EXPECT_EQ(svg.find("inf"), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace lodestone::report
