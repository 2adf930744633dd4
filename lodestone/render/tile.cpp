// What each sample of a tile sees: triangles drawn one after the other, the nearest stays.
//
// Method: edge functions in fixed point (J. Pineda, A Parallel Algorithm for Polygon Rasterization,
// 1988 [pineda-1988]), four samples at a time, tested against the nearest so far. The rule for shared
// sides is Direct3D's (top-left).
// 1. owns_side(): which of two triangles gets the samples on their common side; the other's edge function
//    is lowered by 1.
// 2. test_depth(), without_holes(): keeps the nearest of the samples that a triangle covers, but for
//    holes of alpha masks.
// 3. draw_small(): every cell of four samples in the triangle's box, in 32 bits.
// 4. LargeDrawing: edge functions in 64 bits, depth in double; blocks of 8 x 8 pixels that lie outside are left out.
// 5. draw_tile(): chunk after chunk in the surface's order, of each chunk the small triangles and then the large ones.
// Invariants: coverage is decided in whole numbers, so a sample on a side that two triangles share belongs to exactly
// one of them. Of two at the same nearness the one drawn first stays. A tile belongs to one thread.
// Cost: small triangles: some 30 operations, and 15 for each cell that their box touches.
#include <algorithm>

#include "lodestone/math/float4.h"
#include "lodestone/render/holes_detail.h"
#include "lodestone/render/tile_detail.h"

namespace lodestone::render::detail {

namespace {

using UInt4 = std::uint32_t __attribute__((vector_size(16)));
using Long2 = std::int64_t __attribute__((vector_size(16)));

template <class Vector, class T>
Vector splat(T x) {
  return Vector{x, x, x, x};
}

template <class Vector, class T>
Vector& at(T* p) {
  return *reinterpret_cast<Vector*>(p);
}

Float4 to_float4(Int4 a) { return __builtin_convertvector(a, Float4); }

// Of the two triangles on a side from a to b = a + (dx, dy) one has it as (dx, dy), the other as (-dx, -dy): the one
// for which it is a left or top side gets the samples on it.
template <class T>
bool owns_side(T dx, T dy) {
  return dy < 0 || (dy == 0 && dx > 0);
}

// A tile being drawn.
struct Target {
  SampleTile& tile;
  const Holes* holes;  // null = none
  std::int32_t x, y;   // of the tile's first pixel on the picture
  const SamplePattern& pattern;
  std::int32_t shift;         // pixels of a cell in a row: 1 << shift
  std::int32_t per_row;       // cells in a row of the tile
  Float4 sample_x, sample_y;  // samples within a cell, 1/256 pixel
};

Target target_of(SampleTile& tile, std::int32_t x, std::int32_t y, const SamplePattern& pattern, const Holes* holes) {
  const std::int32_t shift = pattern.count == 4 ? 0 : 2;
  Target target{tile, holes, x, y, pattern, shift, kTile >> shift, {}, {}};
  for (std::size_t s = 0; s < 4; ++s) {
    target.sample_x[s] = static_cast<float>(pattern.x[s]);
    target.sample_y[s] = static_cast<float>(pattern.y[s]);
  }
  return target;
}

// Takes out the samples at which the triangle has a hole.
Int4 without_holes(const Target& target, std::uint32_t id, std::int32_t x, std::int32_t y, Int4 inside) {
  constexpr float kPerSub = 1.0F / kSub;
  for (std::size_t s = 0; s < 4; ++s) {
    if (inside[s] == 0) continue;
    const Vec2f at{static_cast<float>((target.x + x) * kSub + target.pattern.x[s]) * kPerSub,
                   static_cast<float>((target.y + y) * kSub + target.pattern.y[s]) * kPerSub};
    if (target.holes->at(id, at)) inside[s] = 0;
  }
  return inside;
}

// Of the cell with its first pixel at (x, y) of the tile.
void test_depth(const Target& target, std::int32_t x, std::int32_t y, Int4 inside, Float4 nearness, std::uint32_t id) {
  const std::size_t sample = static_cast<std::size_t>(y * target.per_row + (x >> target.shift)) * 4;
  Float4& nearest = at<Float4>(&target.tile.nearness[sample]);
  UInt4& ids = at<UInt4>(&target.tile.id[sample]);
  Int4 wins = inside & (nearness > nearest);
  if (target.holes != nullptr && target.holes->has(id)) wins = without_holes(target, id, x, y, wins);
  nearest = wins ? nearness : nearest;
  ids = wins ? splat<UInt4>(id) : ids;
}

void draw_small(const SmallTriangle& t, const Target& target) {
  const std::int32_t x[3] = {t.x[0], t.x[1], t.x[2]}, y[3] = {t.y[0], t.y[1], t.y[2]};
  const std::int32_t width = 1 << target.shift;
  const std::int32_t min_x = (std::max(std::min({x[0], x[1], x[2]}), 0) >> kSubBits) & -width;
  const std::int32_t max_x = std::min(std::max({x[0], x[1], x[2]}) >> kSubBits, kTile - 1);
  const std::int32_t min_y = std::max(std::min({y[0], y[1], y[2]}), 0) >> kSubBits;
  const std::int32_t max_y = std::min(std::max({y[0], y[1], y[2]}) >> kSubBits, kTile - 1);
  const std::int32_t origin_x = min_x << kSubBits, origin_y = min_y << kSubBits;

  Int4 row[3], step_x[3], step_y[3];
  std::int32_t bias[3];
  for (std::size_t k = 0; k < 3; ++k) {  // side k lies across from corner k
    const std::size_t a = (k + 1) % 3, b = (k + 2) % 3;
    const std::int32_t dx = x[b] - x[a], dy = y[b] - y[a];
    bias[k] = owns_side(dx, dy) ? 0 : 1;
    // Products of 15 and 8 bits: exact in float.
    const Float4 of_lanes = splat<Float4>(static_cast<float>(dx)) * target.sample_y -
                            splat<Float4>(static_cast<float>(dy)) * target.sample_x;
    row[k] = __builtin_convertvector(of_lanes, Int4) +
             splat<Int4>(dx * (origin_y - y[a]) - dy * (origin_x - x[a]) - bias[k]);
    step_x[k] = splat<Int4>(-dy * (kSub << target.shift));
    step_y[k] = splat<Int4>(dx * kSub);
  }
  const std::int32_t area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
  const float per_area = 1 / static_cast<float>(area);
  const float g1 = (t.nearness[1] - t.nearness[0]) * per_area, g2 = (t.nearness[2] - t.nearness[0]) * per_area;
  const Float4 base =
      splat<Float4>(t.nearness[0] + static_cast<float>(bias[1]) * g1 + static_cast<float>(bias[2]) * g2);

  for (std::int32_t cell_y = min_y; cell_y <= max_y; ++cell_y) {
    Int4 e0 = row[0], e1 = row[1], e2 = row[2];
    for (std::int32_t cell_x = min_x; cell_x <= max_x; cell_x += width) {
      const Int4 inside = (e0 | e1 | e2) >= 0;
      const Long2 any = reinterpret_cast<Long2>(inside);
      if ((any[0] | any[1]) != 0) {
        test_depth(target, cell_x, cell_y, inside, base + to_float4(e1) * g1 + to_float4(e2) * g2, t.id);
      }
      e0 += step_x[0];
      e1 += step_x[1];
      e2 += step_x[2];
    }
    for (std::size_t k = 0; k < 3; ++k) row[k] += step_y[k];
  }
}

// One edge function of a large triangle, from the tile's corner.
struct EdgeFunction {
  std::int64_t at_corner, step_x, step_y;  // steps: one pixel
  std::array<std::int64_t, 4> of_lanes;
};

// Blocks of 8 x 8 pixels (two cells wide with one sample a pixel) are left out or looked into.
constexpr std::int32_t kBlock = 8;

class LargeDrawing {
 public:
  LargeDrawing(const LargeTriangle& t, const Target& target) : triangle_(t), target_(target) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t a = (k + 1) % 3, b = (k + 2) % 3;
      const std::int64_t dx = t.x[b] - t.x[a], dy = t.y[b] - t.y[a];
      bias_[k] = owns_side(dx, dy) ? 0 : 1;
      EdgeFunction& side = sides_[k];
      side.at_corner =
          dx * (std::int64_t{target.y} * kSub - t.y[a]) - dy * (std::int64_t{target.x} * kSub - t.x[a]) - bias_[k];
      side.step_x = -dy * kSub;
      side.step_y = dx * kSub;
      for (std::size_t s = 0; s < 4; ++s) side.of_lanes[s] = dx * target.pattern.y[s] - dy * target.pattern.x[s];
    }
    const double area = static_cast<double>(std::int64_t{t.x[1] - t.x[0]} * (t.y[2] - t.y[0]) -
                                            std::int64_t{t.x[2] - t.x[0]} * (t.y[1] - t.y[0]));
    base_ = static_cast<double>(t.nearness[0]);
    for (std::size_t k = 1; k < 3; ++k) {
      slope_[k] = (static_cast<double>(t.nearness[k]) - base_) / area;
    }
    base_ += static_cast<double>(bias_[1]) * slope_[1] + static_cast<double>(bias_[2]) * slope_[2];
  }

  void draw() const {
    for (std::int32_t y = 0; y < kTile; y += kBlock) {
      for (std::int32_t x = 0; x < kTile; x += kBlock) {
        bool outside = false;
        for (const EdgeFunction& side : sides_) outside = outside || largest(side, x, y) < 0;
        if (!outside) draw_block(x, y);
      }
    }
  }

 private:
  // An upper bound of a side's function over the samples of a block.
  static std::int64_t largest(const EdgeFunction& side, std::int32_t x, std::int32_t y) {
    const std::int64_t across = side.step_x * kBlock, down = side.step_y * kBlock;
    return side.at_corner + side.step_x * x + side.step_y * y + std::max<std::int64_t>(across, 0) +
           std::max<std::int64_t>(down, 0);
  }

  void draw_block(std::int32_t block_x, std::int32_t block_y) const {
    const std::int32_t width = 1 << target_.shift;
    for (std::int32_t y = block_y; y < block_y + kBlock; ++y) {
      for (std::int32_t x = block_x; x < block_x + kBlock; x += width) {
        Int4 inside;
        Float4 nearness;
        for (std::size_t s = 0; s < 4; ++s) {
          std::int64_t e[3];
          for (std::size_t k = 0; k < 3; ++k) {
            e[k] = sides_[k].at_corner + sides_[k].step_x * x + sides_[k].step_y * y + sides_[k].of_lanes[s];
          }
          inside[s] = (e[0] | e[1] | e[2]) >= 0 ? -1 : 0;
          // In double: where a triangle comes near the eye its far end would lose its depth in float.
          nearness[s] =
              static_cast<float>(base_ + static_cast<double>(e[1]) * slope_[1] + static_cast<double>(e[2]) * slope_[2]);
        }
        test_depth(target_, x, y, inside, nearness, triangle_.id);
      }
    }
  }

  const LargeTriangle& triangle_;
  const Target& target_;
  std::array<EdgeFunction, 3> sides_{};
  std::array<std::int64_t, 3> bias_{};
  std::array<double, 3> slope_{};
  double base_ = 0;
};

bool touches(const LargeTriangle& t, const Target& target) {
  constexpr std::int32_t kSide = kTile * kSub;
  const std::int32_t x = target.x * kSub, y = target.y * kSub;
  return std::min({t.x[0], t.x[1], t.x[2]}) < x + kSide && std::max({t.x[0], t.x[1], t.x[2]}) >= x &&
         std::min({t.y[0], t.y[1], t.y[2]}) < y + kSide && std::max({t.y[0], t.y[1], t.y[2]}) >= y;
}

}  // namespace

void draw_tile(const Bins& bins, std::int32_t column, std::int32_t row, const SamplePattern& pattern,
               const Holes* holes, SampleTile& tile) {
  tile.nearness.fill(0);
  tile.id.fill(kNone);
  const Target target = target_of(tile, column * kTile, row * kTile, pattern, holes);
  for (const ChunkBins& chunk : bins.chunks) {
    const std::int32_t c = column - chunk.first_column, r = row - chunk.first_row;
    if (c < 0 || r < 0 || c >= chunk.columns || r >= chunk.rows) continue;
    const auto index = static_cast<std::size_t>(r * chunk.columns + c);
    for (std::uint32_t i = chunk.small_first[index]; i < chunk.small_first[index + 1]; ++i) {
      draw_small(chunk.small[i], target);
    }
    const auto line = static_cast<std::size_t>(r);
    for (std::uint32_t i = chunk.large_first[line]; i < chunk.large_first[line + 1]; ++i) {
      const LargeTriangle& t = chunk.large[chunk.large_of_row[i]];
      if (touches(t, target)) LargeDrawing(t, target).draw();
    }
  }
}

}  // namespace lodestone::render::detail
