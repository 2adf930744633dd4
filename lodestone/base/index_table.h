// IndexTable: finds equal things by their hashes.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace lodestone {

/// Open addressing over indices of things that lie elsewhere; at most half full.
class IndexTable {
 public:
  static constexpr std::uint32_t kNothing = std::numeric_limits<std::uint32_t>::max();

  /// For `most` things at most.
  explicit IndexTable(std::size_t most) : slots_(std::bit_ceil(2 * most + 1), kNothing) {}

  /// The first index added under this hash for which equal(index) holds; kNothing if there is none.
  template <class Equal>
  std::uint32_t find(std::uint64_t hash, Equal equal) const {
    return slots_[slot_of(hash, equal)];
  }

  /// The same; where there is none, `index` is added and returned.
  template <class Equal>
  std::uint32_t find_or_add(std::uint64_t hash, std::uint32_t index, Equal equal) {
    std::uint32_t& slot = slots_[slot_of(hash, equal)];
    if (slot == kNothing) slot = index;
    return slot;
  }

 private:
  template <class Equal>
  std::size_t slot_of(std::uint64_t hash, Equal equal) const {
    std::size_t slot = hash & (slots_.size() - 1);
    while (slots_[slot] != kNothing && !equal(slots_[slot])) slot = (slot + 1) & (slots_.size() - 1);
    return slot;
  }

  std::vector<std::uint32_t> slots_;
};

}  // namespace lodestone
