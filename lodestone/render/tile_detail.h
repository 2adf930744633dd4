// What each sample of one tile of the picture sees.
#pragma once

#include <array>
#include <cstdint>

#include "lodestone/core/mesh.h"
#include "lodestone/render/bins_detail.h"

namespace lodestone::render::detail {

class Holes;

/// Samples in cells of four: the four of a pixel, or, with one sample a pixel, those of four pixels in a row.
struct SampleTile {
  static constexpr std::size_t kSamples = std::size_t{kTile} * kTile * 4;
  alignas(64) std::array<float, kSamples> nearness;    ///< 0 where nothing is
  alignas(64) std::array<std::uint32_t, kSamples> id;  ///< triangle of the surface; kNone where nothing is

  /// Index of the first sample of a pixel of the tile; its others follow.
  static std::size_t first_sample(std::int32_t x, std::int32_t y, int samples) {
    return static_cast<std::size_t>((y * kTile + x) * samples);
  }
};

/// Draws into the tile at `column`, `row` of the bins everything that touches it: chunk after chunk in the surface's
/// order, of each chunk the small triangles first. Of two at the same nearness the one drawn first stays. A sample on a
/// side that two triangles share belongs to exactly one of them.
/// `holes`: null where no appearance has any.
void draw_tile(const Bins& bins, std::int32_t column, std::int32_t row, const SamplePattern& pattern,
               const Holes* holes, SampleTile& tile);

}  // namespace lodestone::render::detail
