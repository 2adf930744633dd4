// A solid of bits at another resolution.
//
// There are two ways. voxel_value() is the function VoxExt of [voxel-lod], equations 2-11 to 2-14: trilinear
// between the eight voxels around a point. downsample() counts: each larger voxel gets the share of its small ones
// that are set, so that vertices can lie between voxels. docs/papers/voxel.md, "What differs from the paper", says
// why it is preferred.
// 1. cuts(): which small voxels each large one takes along an axis; the sizes need not divide.
// 2. count_row(): the set bits of one row by large voxels: add_row() for 2, 4 and 8 bits in fields of a word,
//    add_row_between(), which skips empty words, for all other sizes.
// 3. voxel_value().
// 4. downsample(): rows added up over y and z, then turned into shares of 0 to 255, where possible by share_table().
// 5. downsample_thin(): the same, but a large voxel with any bit set gets at least 128, so that thin parts stay.
// Invariants: counts are exact; the share is rounded once. Slices of the result are independent: the same bytes for any
// thread count. Cost: O(voxels / 64 + large voxels · r²), r being the old size over the new one.
#include "lodestone/voxel/resample.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>
#include <vector>

#include "lodestone/base/memory.h"
#include "lodestone/base/parallel.h"
#include "lodestone/core/validate.h"

namespace lodestone::voxel {

namespace {

// First small voxel of each large one, and the end.
std::vector<std::uint32_t> cuts(std::uint32_t old_size, std::uint32_t new_size) {
  std::vector<std::uint32_t> out(new_size + 1);
  for (std::uint32_t i = 0; i <= new_size; ++i) {
    out[i] = static_cast<std::uint32_t>(std::uint64_t{i} * old_size / new_size);
  }
  return out;
}

// Bits set from first to end of a row.
std::uint32_t set_between(const std::uint64_t* row, std::uint32_t first, std::uint32_t end) {
  std::uint32_t count = 0;
  while (first < end) {
    const std::uint32_t room = std::min(end - first, 64 - first % 64);
    const std::uint64_t mask = room == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << room) - 1;
    count += static_cast<std::uint32_t>(std::popcount(row[first / 64] >> (first % 64) & mask));
    first += room;
  }
  return count;
}

// Bits set in each field of 2, 4 or 8 bits.
std::uint64_t pairs(std::uint64_t w) { return w - (w >> 1 & 0x5555555555555555); }
std::uint64_t nibbles(std::uint64_t w) {
  const std::uint64_t two = pairs(w);
  return (two & 0x3333333333333333) + (two >> 2 & 0x3333333333333333);
}
std::uint64_t bytes(std::uint64_t w) {
  const std::uint64_t four = nibbles(w);
  return (four + (four >> 4)) & 0x0f0f0f0f0f0f0f0f;
}

// Adds a row's counts of `ratio` voxels each, 64 bits at a time.
void add_row(const std::uint64_t* row, std::uint32_t size, std::uint32_t ratio, std::uint32_t* counts) {
  const std::uint32_t fields = 64 / ratio;
  const std::uint64_t mask = (std::uint64_t{1} << ratio) - 1;
  for (std::uint32_t x = 0; x < size; x += fields) {
    std::uint64_t word = row[x / fields];
    if (word == 0) continue;
    word = ratio == 2 ? pairs(word) : ratio == 4 ? nibbles(word) : bytes(word);
    const std::uint32_t end = std::min(fields, size - x);
    for (std::uint32_t k = 0; k < end; ++k) counts[x + k] += static_cast<std::uint32_t>(word >> (k * ratio) & mask);
  }
}

// As add_row() for larger voxels of any size: words that are empty are skipped, and full ones need no counting.
void add_row_between(const std::uint64_t* row, std::size_t words, std::span<const std::uint32_t> xs,
                     std::uint32_t* counts) {
  const std::size_t size = xs.size() - 1;
  std::size_t x = 0;
  for (std::size_t w = 0; w < words; ++w) {
    if (row[w] == 0) continue;
    const auto begin = static_cast<std::uint32_t>(w * 64), end = begin + 64;
    const bool full = ~row[w] == 0;
    while (x < size && xs[x + 1] <= begin) ++x;
    for (std::size_t k = x; k < size && xs[k] < end; ++k) {
      const std::uint32_t from = std::max(xs[k], begin), to = std::min(xs[k + 1], end);
      counts[k] += full ? to - from : set_between(row, from, to);
    }
  }
}

// The share of `all` bits that is set, 255 = all of them.
std::uint8_t share_of(std::uint64_t count, std::uint64_t all) {
  return static_cast<std::uint8_t>((255 * count + all / 2) / all);
}

// share_of() each count, to be looked up in place of a division a voxel; only {0} where the table would be long.
std::vector<std::uint8_t> share_table(std::uint64_t all) {
  std::vector<std::uint8_t> table(1);
  if (all > 1 << 16) return table;
  for (std::uint64_t count = 1; count <= all; ++count) table.push_back(share_of(count, all));
  return table;
}

// Counts of one row of large voxels.
void count_row(const BitVolume& volume, std::span<const std::uint32_t> xs, std::uint32_t ratio,
               const std::uint64_t* row, std::vector<std::uint32_t>& counts) {
  const auto size = static_cast<std::uint32_t>(counts.size());
  if (ratio == 2 || ratio == 4 || ratio == 8) return add_row(row, size, ratio, counts.data());
  add_row_between(row, volume.row_words, xs, counts.data());
}

}  // namespace

double voxel_value(const BitVolume& volume, Vec3d at) {
  const auto& size = volume.grid.size;
  std::int64_t low[3];
  double share[3];
  for (std::size_t k = 0; k < 3; ++k) {
    if (!(at[k] > -1 && at[k] < size[k])) return 0;
    const double floor = std::floor(at[k]);
    low[k] = static_cast<std::int64_t>(floor);
    share[k] = at[k] - floor;
  }
  double sum = 0;
  for (unsigned c = 0; c < 8; ++c) {
    std::uint32_t p[3];
    double weight = 1;
    bool there = true;
    for (std::size_t k = 0; k < 3; ++k) {
      const bool high = (c >> k & 1) != 0;
      const std::int64_t i = low[k] + (high ? 1 : 0);
      weight *= high ? share[k] : 1 - share[k];
      there = there && i >= 0 && i < size[k];
      p[k] = static_cast<std::uint32_t>(i);
    }
    if (there && volume.at(p[0], p[1], p[2])) sum += weight;
  }
  return sum;
}

Result<ScalarVolume<std::uint8_t>> downsample(const BitVolume& volume, const std::array<std::uint32_t, 3>& size,
                                              Task task) {
  LODESTONE_TRY(validate(volume));
  const auto& old = volume.grid.size;
  for (std::size_t k = 0; k < 3; ++k) {
    if (size[k] >= 1 && size[k] <= old[k]) continue;
    return fail(ErrorCode::bad_argument, fmt::format("{} voxels can't be made from {}", size[k], old[k]), {},
                "use 1 to as many as there are");
  }
  ScalarVolume<std::uint8_t> out;
  out.grid = volume.grid;
  out.grid.size = size;
  for (std::size_t k = 0; k < 3; ++k) out.grid.spacing[k] = volume.grid.spacing[k] * old[k] / size[k];
  resize_large(out.values, static_cast<std::size_t>(out.grid.count()));
  const std::vector<std::uint32_t> xs = cuts(old[0], size[0]), ys = cuts(old[1], size[1]), zs = cuts(old[2], size[2]);
  const std::uint32_t ratio = old[0] % size[0] == 0 ? old[0] / size[0] : 0;  // 0: not a whole number
  const std::vector<std::uint8_t> shares = share_table(std::uint64_t{ratio} * (ys[1] - ys[0]) * (zs[1] - zs[0]));
  parallel_for(size[2], 1, task, [&](std::size_t z, std::size_t, std::size_t) {
    std::vector<std::uint32_t> counts(size[0]);
    for (std::uint32_t y = 0; y < size[1]; ++y) {
      std::fill(counts.begin(), counts.end(), 0);
      for (std::uint32_t fine_z = zs[z]; fine_z < zs[z + 1]; ++fine_z) {
        for (std::uint32_t fine_y = ys[y]; fine_y < ys[y + 1]; ++fine_y) {
          const std::uint64_t* row = volume.words.data() + volume.row_of(fine_y, fine_z);
          count_row(volume, xs, ratio, row, counts);
        }
      }
      const std::uint64_t area = std::uint64_t{zs[z + 1] - zs[z]} * (ys[y + 1] - ys[y]);
      std::uint8_t* values = out.values.data() + out.index(0, y, static_cast<std::uint32_t>(z));
      if (ratio != 0 && area * ratio == shares.size() - 1) {
        for (std::uint32_t x = 0; x < size[0]; ++x) values[x] = shares[counts[x]];
        continue;
      }
      for (std::uint32_t x = 0; x < size[0]; ++x) {
        if (counts[x] != 0) values[x] = share_of(counts[x], area * (xs[x + 1] - xs[x]));
      }
    }
  });
  if (task.cancelled()) return cancelled_error("resampling");
  return out;
}

Result<ScalarVolume<std::uint8_t>> downsample_thin(const BitVolume& volume, const std::array<std::uint32_t, 3>& size,
                                                   Task task) {
  Result<ScalarVolume<std::uint8_t>> shares = downsample(volume, size, task);
  if (!shares) return shares;
  // A share of less than 1/510 has been rounded to 0 and stays outside unless its voxels are looked at again.
  const auto& old = volume.grid.size;
  const std::vector<std::uint32_t> xs = cuts(old[0], size[0]), ys = cuts(old[1], size[1]), zs = cuts(old[2], size[2]);
  parallel_for(size[2], 1, task, [&](std::size_t slice, std::size_t, std::size_t) {
    const auto z = static_cast<std::uint32_t>(slice);
    std::vector<std::uint64_t> any(volume.row_words);
    for (std::uint32_t y = 0; y < size[1]; ++y) {
      std::fill(any.begin(), any.end(), 0);
      for (std::uint32_t fine_z = zs[z]; fine_z < zs[z + 1]; ++fine_z) {
        for (std::uint32_t fine_y = ys[y]; fine_y < ys[y + 1]; ++fine_y) {
          const std::uint64_t* row = volume.words.data() + volume.row_of(fine_y, fine_z);
          for (std::size_t w = 0; w < any.size(); ++w) any[w] |= row[w];
        }
      }
      std::uint8_t* values = shares->values.data() + shares->index(0, y, z);
      for (std::uint32_t x = 0; x < size[0]; ++x) {
        if (values[x] < 128 && set_between(any.data(), xs[x], xs[x + 1]) > 0) values[x] = 128;
      }
    }
  });
  if (task.cancelled()) return cancelled_error("resampling");
  return shares;
}

}  // namespace lodestone::voxel
