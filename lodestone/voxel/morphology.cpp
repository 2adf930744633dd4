// Voxels grown, shrunk and flooded: what the closing of scans and of open surfaces is made of.
//
// Method: closing by a ball (J. Serra, Image Analysis and Mathematical Morphology, 1982 [serra-1982]). Shapes are grown
// by a radius, what can't be reached from outside is inside, and the growth is taken back. To grow or to shrink is to
// compare squared distances with the radius squared.
// 1. distances_sq(): exact squared distances, one axis after the other: row_distances() along x from the bits,
//    then Plane::sweep() along y and along z, which lowers a row to what another one says plus the square of
//    how far that is.
// 2. within(): the voxels whose squared distance is at most that of a radius.
// 3. flooded_from_outside(): Flood begins at the sides of the grid and goes over sides of free voxels, 64 in a word:
//    spread() fills free bits within a word by steps that double, pass_on() goes on to the six words around.
// 4. complement(): the other voxels.
// Invariants: distances are whole numbers, exact up to `reach`; 180 voxels at most, so that 16 bits hold them. What
// lies around the grid counts as not set. The flood runs on one thread; nothing depends on the number of threads.
// Cost: distances O(voxels · reach), little where rows have nothing near; flood O(voxels / 64), more in mazes.
#include "lodestone/voxel/morphology.h"

#include <algorithm>
#include <bit>
#include <span>
#include <vector>

#include "lodestone/base/check.h"
#include "lodestone/base/parallel.h"

namespace lodestone::voxel {

namespace {

// kBeyondReach plus a square within reach still fits.
static_assert(kBeyondReach + kMostReach * kMostReach <= 0xffff);

// Along x: from the bits of a row.
void row_distances(const BitVolume& volume, std::uint32_t y, std::uint32_t z, std::uint32_t reach, std::uint16_t* row) {
  const std::uint32_t size = volume.grid.size[0];
  const std::uint64_t* words = volume.words.data() + volume.row_of(y, z);
  std::fill(row, row + size, kBeyondReach);
  if (std::all_of(words, words + volume.row_words, [](std::uint64_t w) { return w == 0; })) return;
  const auto set = [&](std::uint32_t x) { return (words[x / 64] >> (x % 64) & 1) != 0; };
  std::uint32_t far = reach + 1;
  for (std::uint32_t x = 0; x < size; ++x) {
    far = set(x) ? 0 : std::min(far + 1, reach + 1);
    if (far <= reach) row[x] = static_cast<std::uint16_t>(far * far);
  }
  far = reach + 1;
  for (std::uint32_t x = size; x-- > 0;) {
    far = set(x) ? 0 : std::min(far + 1, reach + 1);
    if (far <= reach) row[x] = std::min(row[x], static_cast<std::uint16_t>(far * far));
  }
}

// Rows of a plane, `stride` numbers apart, brought nearer by those before and behind them.
class Plane {
 public:
  Plane(std::size_t width, std::size_t rows) : width_(width), rows_(rows), copy_(width * rows), any_(rows) {}

  void sweep(std::uint16_t* first, std::size_t stride, std::uint32_t reach) {
    for (std::size_t r = 0; r < rows_; ++r) {
      const std::uint16_t* from = first + r * stride;
      std::copy(from, from + width_, copy_.begin() + static_cast<std::ptrdiff_t>(r * width_));
      any_[r] = std::any_of(from, from + width_, [](std::uint16_t d) { return d != kBeyondReach; }) ? 1 : 0;
    }
    const std::uint32_t reach_sq = reach * reach;
    for (std::size_t r = 0; r < rows_; ++r) {
      std::uint16_t* into = first + r * stride;
      const std::size_t low = r > reach ? r - reach : 0, high = std::min(rows_ - 1, r + reach);
      bool changed = false;
      for (std::size_t other = low; other <= high; ++other) {
        if (any_[other] == 0 || other == r) continue;
        const std::size_t apart = other > r ? other - r : r - other;
        lower(into, copy_.data() + other * width_, static_cast<std::uint16_t>(apart * apart));
        changed = true;
      }
      if (!changed) continue;
      for (std::size_t x = 0; x < width_; ++x) into[x] = into[x] > reach_sq ? kBeyondReach : into[x];
    }
  }

 private:
  void lower(std::uint16_t* into, const std::uint16_t* from, std::uint16_t more) const {
    for (std::size_t x = 0; x < width_; ++x) {
      const auto there = static_cast<std::uint16_t>(from[x] + more);
      into[x] = there < into[x] ? there : into[x];
    }
  }
  std::size_t width_, rows_;
  std::vector<std::uint16_t> copy_;
  std::vector<std::uint8_t> any_;  // whether a row of the copy has anything within reach
};

std::uint64_t last_word_mask(const VoxelGrid& grid) {
  const std::uint32_t used = grid.size[0] % 64;
  return used == 0 ? ~std::uint64_t{0} : (std::uint64_t{1} << used) - 1;
}

// Bits spread up and down over neighbouring free ones.
std::uint64_t spread(std::uint64_t bits, std::uint64_t free) {
  std::uint64_t up = bits, down = bits, up_free = free, down_free = free;
  for (unsigned step = 1; step < 64; step *= 2) {
    up |= up_free & up << step;
    up_free &= up_free << step;
    down |= down_free & down >> step;
    down_free &= down_free >> step;
  }
  return up | down;
}

class Flood {
 public:
  explicit Flood(const BitVolume& walls) : walls_(walls), out_(walls.grid), mask_(last_word_mask(walls.grid)) {}

  BitVolume run() {
    const auto& size = walls_.grid.size;
    for (std::uint32_t z = 0; z < size[2]; ++z) {
      for (std::uint32_t y = 0; y < size[1]; ++y) seed_row(y, z);
    }
    return std::move(out_);
  }

 private:
  struct Wave {
    std::uint32_t y, z;
    std::size_t word;
    std::uint64_t bits;
  };

  void seed_row(std::uint32_t y, std::uint32_t z) {
    const auto& size = walls_.grid.size;
    const std::size_t last = walls_.row_words - 1;
    if (y == 0 || z == 0 || y + 1 == size[1] || z + 1 == size[2]) {
      for (std::size_t w = 0; w <= last; ++w) reach(y, z, w, ~std::uint64_t{0});
    } else {
      reach(y, z, 0, 1);
      reach(y, z, last, std::uint64_t{1} << ((size[0] - 1) % 64));
    }
    while (!waves_.empty()) {
      const Wave wave = waves_.back();
      waves_.pop_back();
      pass_on(wave);
    }
  }

  void reach(std::uint32_t y, std::uint32_t z, std::size_t word, std::uint64_t bits) {
    const std::size_t at = walls_.row_of(y, z) + word;
    std::uint64_t free = ~walls_.words[at] & ~out_.words[at];
    if (word + 1 == walls_.row_words) free &= mask_;
    bits &= free;
    if (bits == 0) return;
    bits = spread(bits, free);
    out_.words[at] |= bits;
    waves_.push_back({y, z, word, bits});
  }

  void pass_on(const Wave& wave) {
    const auto& size = walls_.grid.size;
    if (wave.y > 0) reach(wave.y - 1, wave.z, wave.word, wave.bits);
    if (wave.y + 1 < size[1]) reach(wave.y + 1, wave.z, wave.word, wave.bits);
    if (wave.z > 0) reach(wave.y, wave.z - 1, wave.word, wave.bits);
    if (wave.z + 1 < size[2]) reach(wave.y, wave.z + 1, wave.word, wave.bits);
    if ((wave.bits & 1) != 0 && wave.word > 0) reach(wave.y, wave.z, wave.word - 1, std::uint64_t{1} << 63);
    if (wave.bits >> 63 != 0 && wave.word + 1 < walls_.row_words) reach(wave.y, wave.z, wave.word + 1, 1);
  }

  const BitVolume& walls_;
  BitVolume out_;
  std::uint64_t mask_;
  std::vector<Wave> waves_;
};

}  // namespace

ScalarVolume<std::uint16_t> distances_sq(const BitVolume& volume, std::uint32_t reach, const Task& task) {
  LODESTONE_CHECK(reach <= kMostReach, "distances are told up to a limit");
  ScalarVolume<std::uint16_t> out;
  out.grid = volume.grid;
  out.values.resize(static_cast<std::size_t>(volume.grid.count()));
  const auto& size = volume.grid.size;
  if (out.values.empty()) return out;
  parallel_for(size[2], 1, task, [&](std::size_t slice, std::size_t, std::size_t) {
    const auto z = static_cast<std::uint32_t>(slice);
    std::uint16_t* first = out.values.data() + out.index(0, 0, z);
    for (std::uint32_t y = 0; y < size[1]; ++y) row_distances(volume, y, z, reach, first + std::size_t{y} * size[0]);
    Plane(size[0], size[1]).sweep(first, size[0], reach);
  });
  parallel_for(size[1], 1, task, [&](std::size_t y, std::size_t, std::size_t) {
    Plane(size[0], size[2]).sweep(out.values.data() + y * size[0], std::size_t{size[0]} * size[1], reach);
  });
  return out;
}

BitVolume within(const ScalarVolume<std::uint16_t>& distances_sq, double radius, const Task& task) {
  BitVolume out(distances_sq.grid);
  const auto& size = out.grid.size;
  const double limit = std::min(radius * radius + 1e-9, static_cast<double>(kMostReach) * kMostReach);
  parallel_for(std::size_t{size[1]} * size[2], 64, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t row = begin; row < end; ++row) {
      const std::uint16_t* values = distances_sq.values.data() + row * size[0];
      for (std::uint32_t x = 0; x < size[0]; ++x) {
        if (values[x] <= limit) out.words[row * out.row_words + x / 64] |= std::uint64_t{1} << (x % 64);
      }
    }
  });
  return out;
}

BitVolume flooded_from_outside(const BitVolume& walls) {
  if (walls.words.empty()) return BitVolume(walls.grid);
  return Flood(walls).run();
}

BitVolume complement(BitVolume volume) {
  const std::uint64_t mask = last_word_mask(volume.grid);
  for (std::size_t i = 0; i < volume.words.size(); ++i) {
    volume.words[i] = ~volume.words[i];
    if (i % volume.row_words == volume.row_words - 1) volume.words[i] &= mask;
  }
  return volume;
}

}  // namespace lodestone::voxel
