// Light and its coding as sRGB (IEC 61966-2-1), the same bits on every machine.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "lodestone/math/vec.h"

namespace lodestone::render::detail {

class Tone {
 public:
  /// The one table, made at first use.
  static const Tone& get();

  /// Light in [0, 1] of a byte of a picture.
  float light(std::uint8_t byte) const { return light_[byte]; }
  Vec3f light(std::uint8_t r, std::uint8_t g, std::uint8_t b) const { return {light_[r], light_[g], light_[b]}; }
  /// The byte for a light, cut to [0, 1]; NaN is 0. At most one step off in the darkest tenth, else nearest.
  std::uint8_t byte(float light) const {
    const float at = light > 0 ? std::min(light, 1.0F) : 0.0F;
    return byte_[static_cast<std::uint32_t>(at * kSteps + 0.5F)];
  }

 private:
  Tone();
  static constexpr int kSteps = 8192;
  std::array<float, 256> light_;
  std::array<std::uint8_t, kSteps + 1> byte_;
};

/// A colour in sRGB, 0 to 1, as light: that of the nearest byte.
inline Vec3f light_of(Vec3f srgb) {
  const auto light = [](float x) {
    return Tone::get().light(static_cast<std::uint8_t>(std::clamp(x, 0.0F, 1.0F) * 255 + 0.5F));
  };
  return {light(srgb.x), light(srgb.y), light(srgb.z)};
}

}  // namespace lodestone::render::detail
