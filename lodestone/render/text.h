// Writing into pictures, with a small font of our own.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "lodestone/core/pixels.h"

namespace lodestone::render {

inline constexpr std::int32_t kGlyphWidth = 5, kGlyphHeight = 7, kGlyphAdvance = 6;

/// Pixels that a text takes in width at a scale of 1.
inline std::int32_t width_of(std::string_view text) {
  return text.empty() ? 0 : static_cast<std::int32_t>(text.size()) * kGlyphAdvance - 1;
}

/// Draws with the upper left corner at (x, y), each dot `scale` pixels wide; what lies off the picture is left out.
/// Knows digits, small letters, and some signs; a hollow box stands for any other.
void draw_text(Pixels& pixels, std::string_view text, std::int32_t x, std::int32_t y, std::int32_t scale,
               const std::array<std::uint8_t, 3>& color);

/// A filled rectangle, cut to the picture; `opacity` 0 to 255.
void fill_box(Pixels& pixels, std::int32_t x, std::int32_t y, std::int32_t width, std::int32_t height,
              const std::array<std::uint8_t, 3>& color, std::uint32_t opacity = 255);

}  // namespace lodestone::render
