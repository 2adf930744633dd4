// Which voxels are inside, a bit each, with an empty layer all around: what Marching Cubes works on.
#pragma once

#include <algorithm>
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
  std::span<const std::uint64_t> bits(std::size_t row) const {
    return std::span(words).subspan(row * row_words, row_words);
  }
  std::span<std::uint64_t> bits(std::size_t row) { return std::span(words).subspan(row * row_words, row_words); }
};

/// Bit x of the next voxel along x.
inline std::uint64_t next_voxels(std::span<const std::uint64_t> row, std::size_t word) {
  return row[word] >> 1 | (word + 1 < row.size() ? row[word + 1] << 63 : 0);
}

/// Edges of one kind in a row that the surface crosses, and how many come before each word.
class CrossedEdges {
 public:
  explicit CrossedEdges(std::size_t words) : masks_(words), before_(words + 1) {}

  void along_x(std::span<const std::uint64_t> row) {
    fill([&](std::size_t w) { return row[w] ^ next_voxels(row, w); });
  }
  void between(std::span<const std::uint64_t> row, std::span<const std::uint64_t> other) {
    fill([&](std::size_t w) { return row[w] ^ other[w]; });
  }

  std::uint32_t count() const { return before_.back(); }
  std::uint32_t rank(std::uint32_t x) const {
    const std::uint64_t below = masks_[x / 64] & ((std::uint64_t{1} << (x % 64)) - 1);
    return before_[x / 64] + static_cast<std::uint32_t>(std::popcount(below));
  }
  /// Calls take(x) in order.
  template <class Take>
  void for_each(Take&& take) const {
    for (std::size_t w = 0; w < masks_.size(); ++w) {
      for (std::uint64_t left = masks_[w]; left != 0; left &= left - 1) {
        take(static_cast<std::uint32_t>(w * 64) + static_cast<std::uint32_t>(std::countr_zero(left)));
      }
    }
  }

 private:
  template <class Mask>
  void fill(Mask&& mask) {
    std::uint32_t count = 0;
    for (std::size_t w = 0; w < masks_.size(); ++w) {
      before_[w] = count;
      masks_[w] = mask(w);
      count += static_cast<std::uint32_t>(std::popcount(masks_[w]));
    }
    before_.back() = count;
  }
  std::vector<std::uint64_t> masks_;
  std::vector<std::uint32_t> before_;
};

}  // namespace lodestone::voxel::detail
