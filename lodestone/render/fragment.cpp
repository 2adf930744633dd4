#include "lodestone/render/fragment_detail.h"

#include <algorithm>
#include <cmath>

namespace lodestone::render::detail {

namespace {

constexpr float kPerSub = 1.0F / kSub;

template <class T>
T cross2(Vec2<T> a, Vec2<T> b) {
  return a.x * b.y - a.y * b.x;
}

// Twice the signed area.
float area_of(const std::array<Vec2f, 3>& c) {
  return cross2(Vec2f{c[1].x - c[0].x, c[1].y - c[0].y}, Vec2f{c[2].x - c[0].x, c[2].y - c[0].y});
}

// The corners as seen from a point of the picture, in pixels; false if one of them is not on it.
bool corners_from(const Raster& raster, const Triangle& names, Vec2f at, std::array<Vec2f, 3>& corners) {
  const std::int32_t x = static_cast<std::int32_t>(at.x * kSub), y = static_cast<std::int32_t>(at.y * kSub);
  for (std::size_t k = 0; k < 3; ++k) {
    const ScreenVertex& v = raster.vertices()[names[k]];
    if (v.outside()) return false;
    corners[k] = {static_cast<float>(v.x - x) * kPerSub, static_cast<float>(v.y - y) * kPerSub};
  }
  return true;
}

// Corners as seen along the ray through a point of the picture: the ray's own direction taken out, in pixels at
// distance 1. Works for corners behind the eye too.
std::array<Vec2d, 3> corners_from_ray(const Raster& raster, const Triangle& names, Vec2f at, bool per_distance) {
  const Projection& projection = raster.projection();
  const Vec2d ray{static_cast<double>(at.x) - projection.center().x, static_cast<double>(at.y) - projection.center().y};
  std::array<Vec2d, 3> corners;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3d eye = projection.to_eye(raster.scene().surface.positions[names[k]]);
    const double w = projection.camera().orthographic ? 1 : eye.z;
    corners[k] = {eye.x * projection.pixels_per_unit() - ray.x * w, -eye.y * projection.pixels_per_unit() - ray.y * w};
    if (per_distance && w > 0) corners[k] = {corners[k].x / w, corners[k].y / w};
  }
  return corners;
}

// Negative weights (a point off the triangle by rounding) are cut off.
Fragment fragment_of(std::array<float, 3> w, float turn) {
  Fragment out;
  out.back = turn > 0;  // rows go down, so that counter-clockwise turns negative
  if (turn < 0) w = {-w[0], -w[1], -w[2]};
  float sum = 0;
  for (float& x : w) {
    x = x > 0 ? x : 0;
    sum += x;
  }
  if (sum > 0 && sum < 3e38F) {
    out.weight = {w[0] / sum, w[1] / sum, w[2] / sum};
  } else {
    out.weight = {1.0F / 3, 1.0F / 3, 1.0F / 3};
  }
  return out;
}

}  // namespace

Fragment fragment_at(const Raster& raster, std::uint32_t triangle, Vec2f at) {
  const Triangle& names = raster.scene().surface.triangles[triangle];
  std::array<Vec2f, 3> c;
  if (corners_from(raster, names, at, c)) {
    std::array<float, 3> w{cross2(c[1], c[2]), cross2(c[2], c[0]), cross2(c[0], c[1])};
    const float turn = area_of(c);
    if (!raster.projection().camera().orthographic) {
      for (std::size_t k = 0; k < 3; ++k) w[k] *= raster.vertices()[names[k]].nearness;
    }
    return fragment_of(w, turn);
  }
  const std::array<Vec2d, 3> d = corners_from_ray(raster, names, at, false);
  const std::array<double, 3> w{cross2(d[1], d[2]), cross2(d[2], d[0]), cross2(d[0], d[1])};
  const double sum = w[0] + w[1] + w[2], scale = std::abs(w[0]) + std::abs(w[1]) + std::abs(w[2]);
  if (!(scale > 0) || !std::isfinite(scale)) return fragment_of({}, -1);
  return fragment_of(
      {static_cast<float>(w[0] / scale), static_cast<float>(w[1] / scale), static_cast<float>(w[2] / scale)},
      static_cast<float>(sum / scale));
}

SideDistances side_distances(const Raster& raster, std::uint32_t triangle, Vec2f at) {
  const Triangle& names = raster.scene().surface.triangles[triangle];
  std::array<Vec2f, 3> c;
  if (!corners_from(raster, names, at, c)) {
    const std::array<Vec2d, 3> d = corners_from_ray(raster, names, at, true);
    for (std::size_t k = 0; k < 3; ++k) c[k] = {static_cast<float>(d[k].x), static_cast<float>(d[k].y)};
  }
  SideDistances out{};
  const float area = std::abs(area_of(c));
  float longest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec2f a = c[(k + 1) % 3], b = c[(k + 2) % 3];
    const Vec2f side{b.x - a.x, b.y - a.y};
    const float length = std::sqrt(side.x * side.x + side.y * side.y);
    longest = std::max(longest, length);
    out.to_side[k] = length > 0 ? std::abs(cross2(a, b)) / length : std::sqrt(a.x * a.x + a.y * a.y);
  }
  out.height = longest > 0 ? area / longest : 0;
  return out;
}

}  // namespace lodestone::render::detail
