// Volumes: values on a regular grid of voxels.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lodestone/base/memory.h"
#include "lodestone/math/vec.h"

namespace lodestone {

/// Where the voxels of a volume lie. Voxel (x, y, z) is a box of `spacing`; its value stands for its centre.
struct VoxelGrid {
  std::array<std::uint32_t, 3> size{};  ///< voxels along x, y, z
  Vec3d origin;                         ///< outer corner of voxel (0, 0, 0), model units
  Vec3d spacing{1, 1, 1};               ///< sides of a voxel, model units, above 0

  std::uint64_t count() const { return std::uint64_t{size[0]} * size[1] * size[2]; }
  /// The point at these voxel coordinates; (x + 0.5, y + 0.5, z + 0.5) is the centre of voxel (x, y, z).
  Vec3d point(Vec3d voxel) const {
    return {origin.x + voxel.x * spacing.x, origin.y + voxel.y * spacing.y, origin.z + voxel.z * spacing.z};
  }
};

/// A bit a voxel: set = inside. Rows along x in words of 64, the lowest bit first; unused bits at a row's end are 0.
struct BitVolume {
  VoxelGrid grid;
  std::size_t row_words = 0;  ///< words of a row
  std::vector<std::uint64_t> words;

  BitVolume() = default;
  /// All 0. Memory: an eighth of a byte a voxel.
  explicit BitVolume(const VoxelGrid& of) : grid(of), row_words((of.size[0] + 63) / 64) {
    resize_large(words, row_words * of.size[1] * of.size[2]);
  }

  std::size_t row_of(std::uint32_t y, std::uint32_t z) const { return (std::size_t{z} * grid.size[1] + y) * row_words; }
  bool at(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
    return (words[row_of(y, z) + x / 64] >> (x % 64) & 1) != 0;
  }
  void set(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    words[row_of(y, z) + x / 64] |= std::uint64_t{1} << (x % 64);
  }
  /// How many voxels are set. O(words).
  std::uint64_t set_count() const {
    std::uint64_t count = 0;
    for (const std::uint64_t word : words) count += static_cast<std::uint64_t>(std::popcount(word));
    return count;
  }
};

/// A number a voxel, x fastest, wherever the numbers live.
template <class T>
struct VolumeView {
  VoxelGrid grid;
  std::span<const T> values;

  std::size_t index(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
    return (std::size_t{z} * grid.size[1] + y) * grid.size[0] + x;
  }
  T at(std::uint32_t x, std::uint32_t y, std::uint32_t z) const { return values[index(x, y, z)]; }
};

/// A number a voxel, x fastest.
template <class T>
struct ScalarVolume {
  VoxelGrid grid;
  std::vector<T> values;

  std::size_t index(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
    return (std::size_t{z} * grid.size[1] + y) * grid.size[0] + x;
  }
  T at(std::uint32_t x, std::uint32_t y, std::uint32_t z) const { return values[index(x, y, z)]; }
  VolumeView<T> view() const { return {grid, values}; }
  operator VolumeView<T>() const { return view(); }
};

}  // namespace lodestone
