// From the world to the picture: vertices in fixed point, with a nearness for the depth test.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "lodestone/base/task.h"
#include "lodestone/math/box.h"
#include "lodestone/math/camera.h"
#include "lodestone/math/vec.h"

namespace lodestone::render::detail {

/// Positions on the picture are whole multiples of 1/256 pixel, from the top left corner of the top left pixel.
inline constexpr int kSubBits = 8;
inline constexpr std::int32_t kSub = 1 << kSubBits;
/// How far from the picture's corner a vertex may lie, pixels; what reaches beyond is clipped.
inline constexpr std::int32_t kGuard = 1 << 15;

struct ScreenVertex {
  std::int32_t x = kOutside, y = 0;
  /// Linear on the picture, larger = nearer, in (0, 1]: perspective near/w, orthographic from 1 (near) to 0 (far).
  float nearness = 0;
  /// x of a vertex that is nearer than the near plane, off the guard band, or not finite.
  static constexpr std::int32_t kOutside = std::numeric_limits<std::int32_t>::min();
  bool outside() const { return x == kOutside; }
};

/// A camera with a picture's size.
class Projection {
 public:
  Projection(const Camera& camera, std::uint32_t width, std::uint32_t height, const Box3d& bounds);

  /// Right, up and forward from the eye, model units.
  Vec3d to_eye(Vec3d world) const {
    const Vec3d p = world - camera_.eye;
    return {dot(p, camera_.right), dot(p, camera_.up), dot(p, camera_.forward)};
  }
  /// On the picture, pixels; `eye` in front of the near plane.
  Vec2d to_pixel(Vec3d eye) const {
    const double scale = camera_.orthographic ? pixels_ : pixels_ / eye.z;
    return {center_.x + eye.x * scale, center_.y - eye.y * scale};
  }
  double nearness(Vec3d eye) const { return camera_.orthographic ? (far_ - eye.z) / (far_ - near_) : near_ / eye.z; }
  /// Distance along the view direction, model units.
  double depth_of(float nearness) const {
    const auto n = static_cast<double>(nearness);
    return camera_.orthographic ? far_ - n * (far_ - near_) : near_ / n;
  }
  ScreenVertex project(Vec3d world) const;
  std::vector<ScreenVertex> project_all(const std::vector<Vec3d>& world, const Task& task) const;

  const Camera& camera() const { return camera_; }
  std::uint32_t width() const { return width_; }
  std::uint32_t height() const { return height_; }
  double near_distance() const { return near_; }
  /// Pixels that a length of 1 covers at distance 1 (orthographic: at any distance).
  double pixels_per_unit() const { return pixels_; }
  Vec2d center() const { return center_; }

 private:
  Camera camera_;
  std::uint32_t width_, height_;
  Vec2d center_;
  double pixels_ = 1, near_ = 1, far_ = 2;
};

/// Pixels to fixed point, rounded; |pixels| at most 2 * kGuard.
inline std::int32_t to_fixed(double pixels) {
  constexpr double kShift = 4.0 * kGuard * kSub;  // makes it positive, so that cutting rounds down
  return static_cast<std::int32_t>(pixels * kSub + kShift + 0.5) - static_cast<std::int32_t>(kShift);
}

}  // namespace lodestone::render::detail
