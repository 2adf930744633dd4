// Position along a Hilbert curve: near in the key, near in space.
#pragma once

#include <cstdint>

namespace lodestone::spatial {

/// Key of a cell of a 2^kBits cube along a three-dimensional Hilbert curve, 3 kBits bits; at most 16.
/// Source: Skilling, "Programming the Hilbert curve", 2004 (axes to transpose).
template <unsigned kBits = 16>
constexpr std::uint64_t hilbert_key(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  std::uint32_t axes[3] = {x, y, z};
  for (std::uint32_t q = 1U << (kBits - 1); q > 1; q >>= 1) {
    const std::uint32_t p = q - 1;
    for (std::uint32_t& axis : axes) {
      if ((axis & q) != 0) {
        axes[0] ^= p;
      } else {
        const std::uint32_t t = (axes[0] ^ axis) & p;
        axes[0] ^= t;
        axis ^= t;
      }
    }
  }
  axes[1] ^= axes[0];
  axes[2] ^= axes[1];
  std::uint32_t t = 0;
  for (std::uint32_t q = 1U << (kBits - 1); q > 1; q >>= 1) {
    if ((axes[2] & q) != 0) t ^= q - 1;
  }
  const auto spread = [](std::uint64_t v) {  // two zero bits after each of 16 bits
    v = (v | v << 16) & 0x0000ff0000ffULL;
    v = (v | v << 8) & 0x00f00f00f00fULL;
    v = (v | v << 4) & 0x0c30c30c30c3ULL;
    return (v | v << 2) & 0x249249249249ULL;
  };
  return spread(axes[0] ^ t) << 2 | spread(axes[1] ^ t) << 1 | spread(axes[2] ^ t);
}

}  // namespace lodestone::spatial
