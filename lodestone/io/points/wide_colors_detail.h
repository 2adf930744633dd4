// Colours of 16 bits, which many programs fill with numbers of 8.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace lodestone::io {

/// All colours of a file as bytes: where none is above 255 they are bytes already.
inline std::vector<std::array<std::uint8_t, 4>> bytes_of(const std::vector<std::array<std::uint16_t, 3>>& wide) {
  std::uint16_t largest = 0;
  for (const auto& c : wide) largest = std::max({largest, c[0], c[1], c[2]});
  std::vector<std::array<std::uint8_t, 4>> out(wide.size());
  for (std::size_t i = 0; i < wide.size(); ++i) {
    out[i][3] = 255;
    for (std::size_t k = 0; k < 3; ++k) {
      const unsigned value = wide[i][k];
      out[i][k] = static_cast<std::uint8_t>(largest > 255 ? (value + 128) / 257 : value);
    }
  }
  return out;
}

}  // namespace lodestone::io
