#include "lodestone/voxel/morphology.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "lodestone/base/random.h"

namespace lodestone::voxel {
namespace {

BitVolume noise(std::array<std::uint32_t, 3> size, std::uint64_t one_in, std::uint64_t seed) {
  VoxelGrid grid;
  grid.size = size;
  BitVolume out(grid);
  std::uint64_t i = 0;
  for (std::uint32_t z = 0; z < size[2]; ++z) {
    for (std::uint32_t y = 0; y < size[1]; ++y) {
      for (std::uint32_t x = 0; x < size[0]; ++x) {
        if (random_bits(seed, i++) % one_in == 0) out.set(x, y, z);
      }
    }
  }
  return out;
}

std::vector<std::array<int, 3>> voxels_of(const BitVolume& volume) {
  std::vector<std::array<int, 3>> out;
  const auto& size = volume.grid.size;
  for (std::uint32_t z = 0; z < size[2]; ++z) {
    for (std::uint32_t y = 0; y < size[1]; ++y) {
      for (std::uint32_t x = 0; x < size[0]; ++x) {
        if (volume.at(x, y, z)) out.push_back({static_cast<int>(x), static_cast<int>(y), static_cast<int>(z)});
      }
    }
  }
  return out;
}

TEST(Morphology, distances_are_those_of_brute_force) {
  for (const std::array<std::uint32_t, 3>& size :
       {std::array<std::uint32_t, 3>{40, 30, 20}, {70, 9, 11}, {1, 1, 1}, {64, 3, 2}, {5, 80, 3}}) {
    const BitVolume volume = noise(size, 200, size[0]);
    const auto set = voxels_of(volume);
    for (const std::uint32_t reach : {1U, 4U, 100U}) {
      const auto distances = distances_sq(volume, reach);
      for (std::uint32_t z = 0; z < size[2]; ++z) {
        for (std::uint32_t y = 0; y < size[1]; ++y) {
          for (std::uint32_t x = 0; x < size[0]; ++x) {
            int best = kBeyondReach;
            for (const auto& s : set) {
              const int dx = s[0] - static_cast<int>(x), dy = s[1] - static_cast<int>(y),
                        dz = s[2] - static_cast<int>(z);
              best = std::min(best, dx * dx + dy * dy + dz * dz);
            }
            if (best > static_cast<int>(reach * reach)) best = kBeyondReach;
            ASSERT_EQ(distances.at(x, y, z), best) << x << ' ' << y << ' ' << z << " reach " << reach;
          }
        }
      }
    }
  }
}

TEST(Morphology, flood_reaches_what_a_slow_one_reaches) {
  for (const std::array<std::uint32_t, 3>& size :
       {std::array<std::uint32_t, 3>{66, 12, 10}, {64, 9, 9}, {130, 7, 8}, {10, 10, 10}, {1, 5, 1}}) {
    for (const std::uint64_t one_in : {2U, 3U, 100U}) {
      const BitVolume walls = noise(size, one_in, 7 + one_in);
      const BitVolume flooded = flooded_from_outside(walls);
      BitVolume slow(walls.grid);
      bool more = true;
      const auto wet = [&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
        return x >= size[0] || y >= size[1] || z >= size[2] || slow.at(x, y, z);  // -1 is large
      };
      while (more) {
        more = false;
        for (std::uint32_t z = 0; z < size[2]; ++z) {
          for (std::uint32_t y = 0; y < size[1]; ++y) {
            for (std::uint32_t x = 0; x < size[0]; ++x) {
              if (walls.at(x, y, z) || slow.at(x, y, z)) continue;
              if (wet(x - 1, y, z) || wet(x + 1, y, z) || wet(x, y - 1, z) || wet(x, y + 1, z) || wet(x, y, z - 1) ||
                  wet(x, y, z + 1)) {
                slow.set(x, y, z);
                more = true;
              }
            }
          }
        }
      }
      EXPECT_EQ(flooded.words, slow.words) << size[0] << " one in " << one_in;
    }
  }
}

TEST(Morphology, complement_keeps_unused_bits_clear) {
  const BitVolume volume = noise({70, 3, 3}, 3, 1);
  const BitVolume other = complement(volume);
  EXPECT_EQ(volume.set_count() + other.set_count(), volume.grid.count());
  EXPECT_EQ(complement(other).words, volume.words);
}

TEST(Morphology, same_for_any_thread_count) {
  const BitVolume volume = noise({100, 80, 60}, 500, 3);
  const auto one = distances_sq(volume, 12, Task::root({}, 1));
  for (const int threads : {2, 7}) {
    const auto other = distances_sq(volume, 12, Task::root({}, threads));
    EXPECT_EQ(one.values, other.values);
    EXPECT_EQ(within(one, 5, Task::root({}, 1)).words, within(other, 5, Task::root({}, threads)).words);
  }
}

}  // namespace
}  // namespace lodestone::voxel
