// Numbers of the vertices around cut cubes, found from left to right along a row of cubes.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

#include "lodestone/voxel/cube_surface_detail.h"
#include "lodestone/voxel/inside_rows_detail.h"

namespace lodestone::voxel::detail {

/// The four rows of a row of cubes: (y, z), (y + 1, z), (y, z + 1), (y + 1, z + 1).
struct FourRows {
  const std::uint64_t* at[4];

  FourRows(const InsideRows& rows, std::uint32_t y, std::uint32_t z)
      : at{rows.bits(rows.row(y, z)), rows.bits(rows.row(y + 1, z)), rows.bits(rows.row(y, z + 1)),
           rows.bits(rows.row(y + 1, z + 1))} {}
};

inline std::uint32_t count_of(std::uint64_t bits) { return static_cast<std::uint32_t>(std::popcount(bits)); }

/// Numbers of the vertices on the eight rows of edges beside a row of cubes, found from left to right.
class RowNumbers {
 public:
  RowNumbers(const InsideRows& rows, const CubeSurface& surface, std::uint32_t y, std::uint32_t z)
      : rows_(rows), four_(rows, y, z) {
    const std::size_t at[4] = {rows.row(y, z), rows.row(y + 1, z), rows.row(y, z + 1), rows.row(y + 1, z + 1)};
    for (std::size_t k = 0; k < 4; ++k) before_[k] = surface.first_vertex[0][at[k]];
    before_[4] = surface.first_vertex[1][at[0]];  // along y, at z and z + 1
    before_[5] = surface.first_vertex[1][at[2]];
    before_[6] = surface.first_vertex[2][at[0]];  // along z, at y and y + 1
    before_[7] = surface.first_vertex[2][at[1]];
  }

  /// The twelve vertices of the cube at x, of which those on crossed edges mean something. Cubes must come in order; no
  /// edge is crossed in words without cubes.
  void of_cube(std::uint32_t x, std::uint32_t (&vertex)[12]) {
    if (x / 64 != word_) enter(x / 64);
    const unsigned bit = x % 64;
    const std::uint64_t below = (std::uint64_t{1} << bit) - 1;
    std::uint32_t rank[8];
    for (std::size_t k = 0; k < 8; ++k) {
      rank[k] = before_[k] + count_of(mask_[k] & below);
    }
    for (std::size_t k = 0; k < 4; ++k) vertex[k] = rank[k];
    // Corner 0, 1 (x + 1), 4 (z + 1), 5 for the edges along y; 0, 1, 2 (y + 1), 3 for those along z.
    for (std::size_t k = 0; k < 2; ++k) {
      vertex[4 + 2 * k] = rank[4 + k];
      vertex[5 + 2 * k] = rank[4 + k] + static_cast<std::uint32_t>(mask_[4 + k] >> bit & 1);
      vertex[8 + 2 * k] = rank[6 + k];
      vertex[9 + 2 * k] = rank[6 + k] + static_cast<std::uint32_t>(mask_[6 + k] >> bit & 1);
    }
  }

 private:
  void enter(std::uint32_t word) {
    for (std::size_t k = 0; k < 8; ++k) before_[k] += count_of(mask_[k]);
    word_ = word;
    const auto& at = four_.at;
    for (std::size_t k = 0; k < 4; ++k) mask_[k] = at[k][word] ^ rows_.next_along_x(at[k], word);
    mask_[4] = at[0][word] ^ at[1][word];
    mask_[5] = at[2][word] ^ at[3][word];
    mask_[6] = at[0][word] ^ at[2][word];
    mask_[7] = at[1][word] ^ at[3][word];
  }

  const InsideRows& rows_;
  FourRows four_;
  std::uint32_t word_ = kNone;
  std::uint64_t mask_[8] = {};    // crossed edges of this word
  std::uint32_t before_[8] = {};  // vertices before it
};

/// Calls take(x, y, corners, vertices) for the cut cubes of a slice, in order.
template <class Take>
void for_each_cube(const InsideRows& rows, const CubeSurface& surface, std::uint32_t z, Take&& take) {
  const std::uint32_t* cube = surface.cubes[z].data();
  for (std::uint32_t y = 0; y + 1 < rows.height; ++y) {
    const std::uint32_t count = surface.row_cubes[rows.row(y, z)];
    if (count == 0) continue;
    RowNumbers numbers(rows, surface, y, z);
    std::uint32_t vertex[12];
    for (std::uint32_t i = 0; i < count; ++i, ++cube) {
      numbers.of_cube(*cube >> 8, vertex);
      take(*cube >> 8, y, *cube & 255, vertex);
    }
  }
}

}  // namespace lodestone::voxel::detail
