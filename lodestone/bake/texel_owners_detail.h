// Which triangle each texel of a texture belongs to.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "lodestone/base/task.h"
#include "lodestone/core/mesh.h"
#include "lodestone/spatial/drawn_attributes.h"

namespace lodestone::bake::detail {

/// A texture cut into square tiles, which keep near texels together; the unit of parallel work.
struct Tiles {
  static constexpr std::uint32_t kSide = 64;
  std::uint32_t size;  // of the texture
  std::uint32_t per_row() const { return (size + kSide - 1) / kSide; }
  std::size_t count() const { return std::size_t{per_row()} * per_row(); }
  /// Calls use(x, y) for each texel of a tile, row by row.
  template <class Use>
  void for_each(std::size_t tile, Use&& use) const {
    const auto x0 = static_cast<std::uint32_t>(tile % per_row()) * kSide;
    const auto y0 = static_cast<std::uint32_t>(tile / per_row()) * kSide;
    for (std::uint32_t y = y0; y < std::min(size, y0 + kSide); ++y) {
      for (std::uint32_t x = x0; x < std::min(size, x0 + kSide); ++x) use(x, y);
    }
  }
};

/// What a texel shows.
struct TexelOwner {
  std::uint32_t triangle = kNone;
  float distance_sq = 0;  ///< of the texel's centre to the triangle, texels; 0 = covered
};

/// One a texel, row by row from the top: the triangle nearest to its centre, if that is not farther than `reach`
/// texels; of several the lowest number. `uv` holds two floats a wedge. O(triangles + texels).
std::vector<TexelOwner> texel_owners(const Mesh& mesh, const std::vector<float>& uv, std::uint32_t size, double reach,
                                     const Task& task);

/// The point of the triangle that is nearest to a point of the texture, in texels.
spatial::SurfacePoint place_in_texture(const Mesh& mesh, const std::vector<float>& uv, std::uint32_t size,
                                       std::uint32_t triangle, Vec2d texel);

}  // namespace lodestone::bake::detail
