// Alpha masks: triangles that are there only where their appearance's alpha reaches the cutoff.
#pragma once

#include <cstdint>

#include "lodestone/math/vec.h"
#include "lodestone/render/raster_detail.h"

namespace lodestone::render::detail {

class Holes {
 public:
  /// `raster` must outlive it.
  explicit Holes(const Raster& raster) : raster_(raster) {}

  bool has(std::uint32_t id) const { return raster_.scene().appearance_of(id).alpha_cutoff > 0; }
  /// Whether there is a hole in triangle `id` at (x, y) pixels of the picture.
  bool at(std::uint32_t id, Vec2f at) const;

 private:
  const Raster& raster_;
};

}  // namespace lodestone::render::detail
