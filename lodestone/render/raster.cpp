#include <fmt/format.h>

#include <cmath>

#include "lodestone/render/frame.h"
#include "lodestone/render/holes_detail.h"
#include "lodestone/render/raster_detail.h"

namespace lodestone::render::detail {

Result<void> check_view(const Camera& camera, std::uint32_t width, std::uint32_t height, int samples) {
  if (width == 0 || height == 0 || width > kMostSide || height > kMostSide) {
    return fail(ErrorCode::bad_argument, fmt::format("a picture of {} x {} pixels can't be drawn", width, height), {},
                fmt::format("sides may be 1 to {}", kMostSide));
  }
  if (samples != 1 && samples != 4) {
    return fail(ErrorCode::bad_argument, fmt::format("{} samples a pixel can't be drawn", samples), {}, "use 1 or 4");
  }
  const double unit = length_sq(camera.right) + length_sq(camera.up) + length_sq(camera.forward);
  const bool sound = is_finite(camera.eye) && std::abs(unit - 3) < 1e-6 && std::isfinite(camera.half_height) &&
                     camera.half_height > 0 && std::isfinite(camera.near_distance) && camera.near_distance > 0;
  if (!sound) {
    return fail(ErrorCode::bad_argument, "the camera's eye, directions or width are no finite numbers above 0", {},
                "make it with look_at() or frame_bounds()");
  }
  return {};
}

Raster::Raster(const SceneData& scene, const Camera& camera, std::uint32_t width, std::uint32_t height, int samples,
               const Task& task)
    : scene_(scene), pattern_(SamplePattern::of(samples)), projection_(camera, width, height, scene.bounds) {
  vertices_ = projection_.project_all(scene.surface.positions, task);
  bins_ = bin_triangles(projection_, scene.surface.positions, vertices_, scene.surface.triangles, pattern_, task);
}

void Raster::draw(std::int32_t column, std::int32_t row, SampleTile& tile) const {
  const Holes holes(*this);
  draw_tile(bins_, column, row, pattern_, scene_.masked ? &holes : nullptr, tile);
}

}  // namespace lodestone::render::detail
