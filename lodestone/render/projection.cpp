#include <algorithm>
#include <cmath>

#include "lodestone/base/parallel.h"
#include "lodestone/render/projection_detail.h"

namespace lodestone::render::detail {

Projection::Projection(const Camera& camera, std::uint32_t width, std::uint32_t height, const Box3d& bounds)
    : camera_(camera), width_(width), height_(height), center_{width * 0.5, height * 0.5} {
  pixels_ = height * 0.5 / camera.half_height;
  near_ = camera.near_distance;
  double farthest = near_;
  for (std::size_t i = 0; i < 8; ++i) {
    const Vec3d corner{(i & 1) != 0 ? bounds.max.x : bounds.min.x, (i & 2) != 0 ? bounds.max.y : bounds.min.y,
                       (i & 4) != 0 ? bounds.max.z : bounds.min.z};
    farthest = std::max(farthest, to_eye(corner).z);
  }
  far_ = near_ + (farthest - near_) * 1.001;  // nearness stays above 0
  if (!(far_ > near_)) far_ = near_ * 2;
}

ScreenVertex Projection::project(Vec3d world) const {
  const Vec3d eye = to_eye(world);
  ScreenVertex out;
  if (!(eye.z >= near_)) return out;
  const Vec2d pixel = to_pixel(eye);
  if (!(std::abs(pixel.x) <= kGuard && std::abs(pixel.y) <= kGuard)) return out;
  out.x = to_fixed(pixel.x);
  out.y = to_fixed(pixel.y);
  out.nearness = static_cast<float>(nearness(eye));
  return out;
}

std::vector<ScreenVertex> Projection::project_all(const std::vector<Vec3d>& world, const Task& task) const {
  constexpr std::size_t kChunk = 16384;
  std::vector<ScreenVertex> out(world.size());
  parallel_for(world.size(), kChunk, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t v = begin; v < end; ++v) out[v] = project(world[v]);
  });
  return out;
}

}  // namespace lodestone::render::detail
