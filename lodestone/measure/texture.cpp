#include <algorithm>
#include <array>
#include <cmath>

#include "lodestone/measure/texture_detail.h"

namespace lodestone::measure::detail {

namespace {

std::array<double, 256> light_table() {
  std::array<double, 256> table{};
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double c = static_cast<double>(i) / 255;
    // pow differs in its last bit between machines; colours are figures to read, nothing is decided by them.
    table[i] = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  }
  return table;
}

// The two neighbours along one axis, wrapped, and the second's weight.
struct Neighbours {
  std::uint32_t first, second;
  double weight;
};

Neighbours neighbours(double coordinate, std::uint32_t size) {
  const double at = (coordinate - std::floor(coordinate)) * size - 0.5;
  const double cell = std::floor(at);
  const auto wrapped = [&](double i) {
    const auto n = static_cast<std::int64_t>(i) % static_cast<std::int64_t>(size);
    return static_cast<std::uint32_t>(n < 0 ? n + size : n);
  };
  return {wrapped(cell), wrapped(cell + 1), at - cell};
}

}  // namespace

Vec2d mapped(Vec2d uv, const TextureCoordinates& coordinates) {
  const std::array<double, 6>& m = coordinates.map;
  return {m[0] * uv.x + m[1] * uv.y + m[2], m[3] * uv.x + m[4] * uv.y + m[5]};
}

Vec3d texture_light(const Pixels& pixels, Vec2d uv) {
  static const std::array<double, 256> kLight = light_table();
  if (pixels.width == 0 || pixels.height == 0 || !std::isfinite(uv.x) || !std::isfinite(uv.y)) return {1, 1, 1};
  const Neighbours x = neighbours(uv.x, pixels.width), y = neighbours(uv.y, pixels.height);
  const auto light = [&](std::uint32_t i, std::uint32_t j) {
    const std::array<std::uint8_t, 4> p = pixels.at(i, j);
    return Vec3d{kLight[p[0]], kLight[p[1]], kLight[p[2]]};
  };
  const Vec3d top = lerp(light(x.first, y.first), light(x.second, y.first), x.weight);
  const Vec3d low = lerp(light(x.first, y.second), light(x.second, y.second), x.weight);
  return lerp(top, low, y.weight);
}

Vec3d to_srgb(Vec3d light) {
  Vec3d out;
  for (std::size_t k = 0; k < 3; ++k) {
    const double c = std::clamp(light[k], 0.0, 1.0);
    out[k] = c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
  }
  return out;
}

}  // namespace lodestone::measure::detail
