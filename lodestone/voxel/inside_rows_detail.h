// Which voxels are inside, a bit each, with an empty layer all around: what Marching Cubes works on.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lodestone::voxel::detail {

/// Rows of a padded volume; (0, 0, 0) is a corner of the layer around it.
struct InsideRows {
  std::uint32_t width = 0, height = 0, depth = 0;  ///< with the layer
  std::size_t row_words = 0;
  std::vector<std::uint64_t> words;

  InsideRows(std::uint32_t x, std::uint32_t y, std::uint32_t z)
      : width(x + 2), height(y + 2), depth(z + 2), row_words((width + 63) / 64), words(row_words * height * depth) {}

  std::size_t row(std::uint32_t y, std::uint32_t z) const { return std::size_t{z} * height + y; }
  std::size_t rows() const { return std::size_t{height} * depth; }
  const std::uint64_t* bits(std::size_t row) const { return words.data() + row * row_words; }
  std::uint64_t* bits(std::size_t row) { return words.data() + row * row_words; }
  /// Bit x of the next voxel along x.
  std::uint64_t next_along_x(const std::uint64_t* row, std::size_t word) const {
    return row[word] >> 1 | (word + 1 < row_words ? row[word + 1] << 63 : 0);
  }

  /// Calls take(x) in order for the edges along an axis, from (x, y, z) to the next voxel, whose ends differ.
  template <class Take>
  void for_each_crossed(std::size_t axis, std::uint32_t y, std::uint32_t z, Take&& take) const {
    if ((axis == 1 && y + 1 == height) || (axis == 2 && z + 1 == depth)) return;
    const std::uint64_t* here = bits(row(y, z));
    const std::uint64_t* other = axis == 1 ? bits(row(y + 1, z)) : axis == 2 ? bits(row(y, z + 1)) : here;
    for (std::size_t w = 0; w < row_words; ++w) {
      const std::uint64_t next = axis == 0 ? next_along_x(here, w) : other[w];
      for (std::uint64_t left = here[w] ^ next; left != 0; left &= left - 1) {
        take(static_cast<std::uint32_t>(w * 64) + static_cast<std::uint32_t>(std::countr_zero(left)));
      }
    }
  }
};

}  // namespace lodestone::voxel::detail
