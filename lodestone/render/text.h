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

/// The upper left corner of a text, and how many pixels wide its dots are.
struct TextPlace {
  std::int32_t x = 0, y = 0, scale = 1;
};

/// A rectangle of pixels.
struct PixelBox {
  std::int32_t x = 0, y = 0, width = 0, height = 0;
};

/// What lies off the picture is left out.
/// Knows digits, small letters, and some signs; a hollow box stands for any other.
void draw_text(Pixels& pixels, std::string_view text, const TextPlace& at, const std::array<std::uint8_t, 3>& color);

/// A filled rectangle, cut to the picture; `opacity` 0 to 255.
void fill_box(Pixels& pixels, const PixelBox& box, const std::array<std::uint8_t, 3>& color,
              std::uint32_t opacity = 255);

}  // namespace lodestone::render
