#include "lodestone/render/legend_detail.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "lodestone/render/color_map.h"
#include "lodestone/render/text.h"

namespace lodestone::render::detail {

namespace {

constexpr std::array<std::uint8_t, 3> kPaper{255, 255, 255}, kInk{30, 32, 36};
constexpr std::int32_t kSteps = 4;  // between the values

// Three digits, enough to read a colour by; what is nothing but rounding beside the range is 0.
std::string number(double value, double span) {
  return fmt::format("{:.3g}", std::max(value, -value) < 1e-9 * span ? 0.0 : value);
}

}  // namespace

void draw_legend(Pixels& pixels, const HeatRange& range, const std::string& unit) {
  const auto width = static_cast<std::int32_t>(pixels.width), height = static_cast<std::int32_t>(pixels.height);
  const std::int32_t scale = std::max(1, height / 300), gap = 4 * scale;
  std::vector<std::string> values;
  std::int32_t text_width = width_of(unit);
  for (std::int32_t i = 0; i <= kSteps; ++i) {
    const double value = range.least + (range.largest - range.least) * i / kSteps;
    values.push_back(number(value, range.largest - range.least));
    text_width = std::max(text_width, width_of(values.back()));
  }
  const std::int32_t bar_width = 10 * scale, bar_height = kSteps * 22 * scale, line = kGlyphHeight * scale;
  const std::int32_t panel_width = bar_width + text_width * scale + 4 * gap;
  const std::int32_t panel_height = bar_height + line + 2 * gap + (unit.empty() ? 0 : line + gap);
  if (panel_width + 2 * gap > width || panel_height + 2 * gap > height) return;
  const std::int32_t left = width - panel_width - 2 * gap, top = height - panel_height - 2 * gap;
  fill_box(pixels, {left, top, panel_width, panel_height}, kPaper, 215);

  const std::int32_t bar_left = left + gap, bar_top = top + gap + line / 2;
  for (std::int32_t y = 0; y < bar_height; ++y) {
    const Vec3f c = heat_color(1 - (static_cast<float>(y) + 0.5F) / static_cast<float>(bar_height));
    std::array<std::uint8_t, 3> color{};
    for (std::size_t k = 0; k < 3; ++k) color[k] = static_cast<std::uint8_t>(c[k] * 255 + 0.5F);
    fill_box(pixels, {bar_left, bar_top + y, bar_width, 1}, color);
  }
  const std::int32_t text_left = bar_left + bar_width + 2 * gap;
  for (std::int32_t i = 0; i <= kSteps; ++i) {
    const std::int32_t y = bar_top + bar_height * (kSteps - i) / kSteps;
    fill_box(pixels, {bar_left + bar_width, y - scale / 2, gap, scale}, kInk);
    draw_text(pixels, values[static_cast<std::size_t>(i)], {text_left, y - line / 2, scale}, kInk);
  }
  draw_text(pixels, unit, {text_left, bar_top + bar_height + line / 2 + gap, scale}, kInk);
}

}  // namespace lodestone::render::detail
