#include "lodestone/render/frame.h"

#include <algorithm>
#include <limits>

#include "lodestone/render/raster_detail.h"

namespace lodestone::render {

Result<Frame> rasterize(const Scene& scene, const Camera& camera, std::uint32_t width, std::uint32_t height,
                        int samples, Task task) {
  LODESTONE_TRY(detail::check_view(camera, width, height, samples));
  const detail::Raster raster(scene.data(), camera, width, height, samples, task);
  Frame frame;
  frame.width = width;
  frame.height = height;
  frame.samples = samples;
  const std::size_t pixels = std::size_t{width} * height;
  frame.coverage.resize(pixels);
  frame.depth.resize(pixels);
  frame.triangle.resize(pixels);
  const auto keep = [&](const detail::SampleTile& tile, std::uint32_t x0, std::uint32_t y0) {
    for (std::uint32_t y = y0; y < std::min<std::uint32_t>(y0 + detail::kTile, height); ++y) {
      for (std::uint32_t x = x0; x < std::min<std::uint32_t>(x0 + detail::kTile, width); ++x) {
        const std::size_t first = detail::SampleTile::first_sample(static_cast<std::int32_t>(x - x0),
                                                                   static_cast<std::int32_t>(y - y0), samples);
        std::uint8_t seen = 0;
        std::size_t nearest = first;
        for (std::size_t s = first; s < first + static_cast<std::size_t>(samples); ++s) {
          if (tile.id[s] != kNone) ++seen;
          if (tile.nearness[s] > tile.nearness[nearest]) nearest = s;
        }
        const std::size_t pixel = std::size_t{y} * width + x;
        const std::uint32_t id = tile.id[nearest];
        frame.coverage[pixel] = seen;
        frame.depth[pixel] = seen > 0 ? static_cast<float>(raster.projection().depth_of(tile.nearness[nearest]))
                                      : std::numeric_limits<float>::infinity();
        frame.triangle[pixel] = seen > 0 ? scene.data().surface.drawn[id] : kNone;
      }
    }
  };
  raster.for_each_tile(task, keep);
  if (task.cancelled()) return cancelled_error("drawing");
  return frame;
}

}  // namespace lodestone::render
