#include "lodestone/core/texture.h"

#include <array>
#include <cmath>

#include "lodestone/core/srgb.h"

namespace lodestone {

namespace {

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
  if (pixels.width == 0 || pixels.height == 0 || !std::isfinite(uv.x) || !std::isfinite(uv.y)) return {1, 1, 1};
  const Neighbours x = neighbours(uv.x, pixels.width), y = neighbours(uv.y, pixels.height);
  const auto light = [&](std::uint32_t i, std::uint32_t j) {
    const std::array<std::uint8_t, 4> p = pixels.at(i, j);
    return Vec3d{light_of_byte(p[0]), light_of_byte(p[1]), light_of_byte(p[2])};
  };
  const Vec3d top = lerp(light(x.first, y.first), light(x.second, y.first), x.weight);
  const Vec3d low = lerp(light(x.first, y.second), light(x.second, y.second), x.weight);
  return lerp(top, low, y.weight);
}

}  // namespace lodestone
