// Unit vectors in 32 bits: the octahedron unfolded to a square, 16 bits a side.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "lodestone/math/vec.h"

namespace lodestone::render::detail {

/// Source: Cigolle et al., "A survey of efficient representations for independent unit vectors", 2014 (oct32).
using PackedNormal = std::uint32_t;

/// Off by at most some 0.004 degrees. The zero vector becomes +z.
inline PackedNormal pack_normal(Vec3d n) {
  const double sum = std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
  if (!(sum > 0)) n = {0, 0, 1};
  double x = n.x / (sum > 0 ? sum : 1), y = n.y / (sum > 0 ? sum : 1);
  if (n.z < 0) {
    const double folded = (1 - std::abs(y)) * (x >= 0 ? 1 : -1);
    y = (1 - std::abs(x)) * (y >= 0 ? 1 : -1);
    x = folded;
  }
  const auto bits = [](double v) { return static_cast<std::uint32_t>(std::clamp(v * 32767 + 32768, 1.0, 65535.0)); };
  return bits(x + 0.5 / 32767) | bits(y + 0.5 / 32767) << 16;
}

/// Not of length 1: its absolute coordinates sum to 1.
inline Vec3f unpack_direction(PackedNormal packed) {
  Vec3f n;
  n.x = static_cast<float>(static_cast<std::int32_t>(packed & 0xFFFF) - 32768) * (1.0F / 32767);
  n.y = static_cast<float>(static_cast<std::int32_t>(packed >> 16) - 32768) * (1.0F / 32767);
  n.z = 1 - std::abs(n.x) - std::abs(n.y);
  const float fold = std::max(-n.z, 0.0F);
  n.x += n.x >= 0 ? -fold : fold;
  n.y += n.y >= 0 ? -fold : fold;
  return n;
}

inline Vec3f unpack_normal(PackedNormal packed) {
  const Vec3f n = unpack_direction(packed);
  return n * (1 / std::sqrt(dot(n, n)));
}

}  // namespace lodestone::render::detail
