#include "lodestone/render/clip_detail.h"

#include <algorithm>

namespace lodestone::render::detail {

namespace {

// Signed distances, positive inside: the near plane, then the four sides of the guard band (in pixels times w).
constexpr std::size_t kPlanes = 5;

double side(const Projection& projection, Vec3d eye, std::size_t plane) {
  if (plane == 0) return eye.z - projection.near_distance();
  const double w = projection.camera().orthographic ? 1 : eye.z;
  const Vec2d center = projection.center();
  const double x = center.x * w + eye.x * projection.pixels_per_unit();
  const double y = center.y * w - eye.y * projection.pixels_per_unit();
  constexpr double kLimit = kGuard;
  return plane == 1 ? x + kLimit * w : plane == 2 ? kLimit * w - x : plane == 3 ? y + kLimit * w : kLimit * w - y;
}

// Where a side crosses a plane, from its inner end (distance above 0) to the outer one (below 0): always in this order,
// so that both neighbours of the side find the same point. Weights of both ends instead of a step from one of them: the
// far end may be so far that a step would lose all digits of the near one.
Vec3d crossing(Vec3d inner, double inside, Vec3d outer, double outside) {
  const double span = inside - outside;
  return inner * (-outside / span) + outer * (inside / span);
}

ScreenVertex snapped(const Projection& projection, Vec3d eye) {
  eye.z = std::max(eye.z, projection.near_distance());
  const Vec2d pixel = projection.to_pixel(eye);
  const auto limited = [](double x) { return std::clamp<double>(x, -kGuard, kGuard); };
  ScreenVertex out;
  out.x = to_fixed(limited(pixel.x));
  out.y = to_fixed(limited(pixel.y));
  out.nearness = static_cast<float>(projection.nearness(eye));
  return out;
}

}  // namespace

ClippedPolygon clip(const Projection& projection, const std::array<Vec3d, 3>& world) {
  std::array<Vec3d, 8> polygon{}, next{};
  std::size_t count = 3;
  for (std::size_t i = 0; i < 3; ++i) {
    polygon[i] = projection.to_eye(world[i]);
    if (!is_finite(polygon[i])) return {};
  }
  for (std::size_t plane = 0; plane < kPlanes && count > 0; ++plane) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3d a = polygon[i], b = polygon[(i + 1) % count];
      const double da = side(projection, a, plane), db = side(projection, b, plane);
      if (da >= 0) next[kept++] = a;
      if ((da >= 0) == (db >= 0)) continue;
      next[kept++] = da >= 0 ? crossing(a, da, b, db) : crossing(b, db, a, da);
    }
    polygon = next;
    count = kept;
  }
  ClippedPolygon out;
  out.count = count < 3 ? 0 : count;
  for (std::size_t i = 0; i < out.count; ++i) out.corners[i] = snapped(projection, polygon[i]);
  return out;
}

}  // namespace lodestone::render::detail
