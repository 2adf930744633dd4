// Pixels: a decoded image.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace lodestone {

/// Eight bits a channel, red, green, blue and alpha (not multiplied into the colours), rows from the top, no padding.
/// Colours are as the file has them: for base colour textures that is sRGB.
struct Pixels {
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint8_t> rgba;  ///< 4 * width * height bytes

  std::array<std::uint8_t, 4> at(std::uint32_t x, std::uint32_t y) const {
    const std::uint8_t* p = rgba.data() + (std::size_t{y} * width + x) * 4;
    return {p[0], p[1], p[2], p[3]};
  }
};

}  // namespace lodestone
