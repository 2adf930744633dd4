// From a scene and a camera to samples, tile by tile: the part that pictures and frames share.
#pragma once

#include <cstdint>
#include <vector>

#include "lodestone/base/parallel.h"
#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/math/camera.h"
#include "lodestone/render/bins_detail.h"
#include "lodestone/render/projection_detail.h"
#include "lodestone/render/scene.h"
#include "lodestone/render/scene_detail.h"
#include "lodestone/render/tile_detail.h"

namespace lodestone::render::detail {

/// Errors: bad_argument.
Result<void> check_view(const Camera& camera, std::uint32_t width, std::uint32_t height, int samples);

class Raster {
 public:
  /// All arguments checked; `scene` must outlive it.
  Raster(const SceneData& scene, const Camera& camera, std::uint32_t width, std::uint32_t height, int samples,
         const Task& task);

  const SceneData& scene() const { return scene_; }
  const Projection& projection() const { return projection_; }
  const std::vector<ScreenVertex>& vertices() const { return vertices_; }
  const SamplePattern& pattern() const { return pattern_; }

  /// Calls body(tile, x, y) for every tile, (x, y) its first pixel on the picture; on many threads.
  template <class Body>
  void for_each_tile(const Task& task, Body&& body) const {
    const auto columns = static_cast<std::size_t>(bins_.columns), rows = static_cast<std::size_t>(bins_.rows);
    parallel_for(columns * rows, 1, task, [&](std::size_t index, std::size_t, std::size_t) {
      const auto column = static_cast<std::int32_t>(index % columns), row = static_cast<std::int32_t>(index / columns);
      SampleTile tile;
      draw(column, row, tile);
      body(tile, static_cast<std::uint32_t>(column * kTile), static_cast<std::uint32_t>(row * kTile));
    });
  }

 private:
  void draw(std::int32_t column, std::int32_t row, SampleTile& tile) const;

  const SceneData& scene_;
  SamplePattern pattern_;
  Projection projection_;
  std::vector<ScreenVertex> vertices_;
  Bins bins_;
};

}  // namespace lodestone::render::detail
