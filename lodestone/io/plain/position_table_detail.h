// PositionTable: joins equal positions while a triangle soup is read, so that the soup never lies in memory as a whole.
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "lodestone/base/random.h"
#include "lodestone/core/mesh.h"

namespace lodestone::io {

class PositionTable {
 public:
  /// The index of this position, new or known (-0 equals 0). Where the table is crowded an equal position may come
  /// twice (weld_exact joins them); so each call takes a bounded time whatever the data.
  std::uint32_t vertex(Vec3f p) {
    p = {p.x + 0.0F, p.y + 0.0F, p.z + 0.0F};  // -0 becomes 0
    if (2 * (positions.size() + 1) > slots_.size()) grow();
    constexpr std::size_t kLongestSearch = 64;
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = hash(p) & mask;
    for (std::size_t steps = 0; steps < kLongestSearch; ++steps, slot = (slot + 1) & mask) {
      if (slots_[slot] == kNone) {
        slots_[slot] = static_cast<std::uint32_t>(positions.size());
        break;
      }
      if (positions[slots_[slot]] == p) return slots_[slot];
    }
    positions.push_back(p);
    return static_cast<std::uint32_t>(positions.size() - 1);
  }

  std::vector<Vec3f> positions;

 private:
  static std::size_t hash(Vec3f p) {
    const std::uint64_t xy = std::uint64_t{std::bit_cast<std::uint32_t>(p.x)} << 32 | std::bit_cast<std::uint32_t>(p.y);
    return static_cast<std::size_t>(mix_bits(xy ^ mix_bits(std::bit_cast<std::uint32_t>(p.z))));
  }

  void grow() {
    slots_.assign(slots_.empty() ? 1024 : 2 * slots_.size(), kNone);
    const std::size_t mask = slots_.size() - 1;
    constexpr std::size_t kLongestSearch = 64;
    for (std::uint32_t i = 0; i < positions.size(); ++i) {
      std::size_t slot = hash(positions[i]) & mask;
      for (std::size_t steps = 0; steps < kLongestSearch; ++steps, slot = (slot + 1) & mask) {
        if (slots_[slot] != kNone) continue;
        slots_[slot] = i;
        break;
      }
    }
  }

  std::vector<std::uint32_t> slots_;  // power of two, at most half full
};

}  // namespace lodestone::io
