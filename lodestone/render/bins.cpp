// Sorts the triangles of a picture by the tiles that they may touch, so that each tile can be drawn by itself.
//
// 1. ChunkBinner::add(): leaves out triangles that lie beside the picture, have no area, or whose box holds no sample,
//    and turns the others so that their area is positive. add_clipped(): parts of triangles that reach too far out or
//    behind the eye (clip.cpp).
// 2. sorted(): counts, offsets, lists. A small triangle, whose box is at most kSmall pixels, is copied into every tile
//    that it touches, relative to that tile's corner: 28 bytes. A larger one is kept once and named by rows of tiles.
// 3. SamplePattern::of(): where the samples of a pixel lie.
// 4. bin_triangles(): chunks of triangles, on all threads.
// Invariants: places are whole numbers, 1/256 pixel. Chunks depend on the number of triangles alone and stay in the
// surface's order, within a list triangles keep theirs: the same bins for any thread count.
// Cost: O(triangles + tiles that they touch).
#include <algorithm>
#include <utility>

#include "lodestone/base/parallel.h"
#include "lodestone/render/bins_detail.h"
#include "lodestone/render/clip_detail.h"

namespace lodestone::render::detail {

namespace {

constexpr std::size_t kLeastChunk = 16384, kMostChunks = 128;

// Tiles from (column0, row0) to (column1, row1), both included.
struct TileRange {
  std::int32_t column0, row0, column1, row1;
};

// A triangle on its way into the bins.
struct Pending {
  LargeTriangle triangle;
  TileRange tiles;
  bool small;
};

class ChunkBinner {
 public:
  ChunkBinner(const Projection& projection, const SamplePattern& pattern, std::int32_t columns, std::int32_t rows)
      : projection_(projection), columns_(columns), rows_(rows) {
    // The distinct sample columns (and rows) of all pixels lie a fixed step apart.
    step_ = pattern.count == 4 ? kSub / 4 : kSub;
    first_ = pattern.count == 4 ? kSub / 8 : kSub / 2;
  }

  void add(std::uint32_t id, const std::array<ScreenVertex, 3>& v) {
    const std::int32_t min_x = std::min({v[0].x, v[1].x, v[2].x}), max_x = std::max({v[0].x, v[1].x, v[2].x});
    const std::int32_t min_y = std::min({v[0].y, v[1].y, v[2].y}), max_y = std::max({v[0].y, v[1].y, v[2].y});
    const auto width = static_cast<std::int32_t>(projection_.width()) * kSub;
    const auto height = static_cast<std::int32_t>(projection_.height()) * kSub;
    if (max_x < 0 || max_y < 0 || min_x >= width || min_y >= height) return;
    if (!holds_sample(min_x, max_x) || !holds_sample(min_y, max_y)) return;
    const std::int64_t area =
        std::int64_t{v[1].x - v[0].x} * (v[2].y - v[0].y) - std::int64_t{v[2].x - v[0].x} * (v[1].y - v[0].y);
    if (area == 0) return;
    const std::size_t b = area > 0 ? 1 : 2, c = 3 - b;
    Pending pending;
    pending.triangle = {
        {v[0].x, v[b].x, v[c].x}, {v[0].y, v[b].y, v[c].y}, {v[0].nearness, v[b].nearness, v[c].nearness}, id};
    constexpr std::int32_t kTileUnits = kTile * kSub;
    pending.tiles = {std::max(min_x, 0) / kTileUnits, std::max(min_y, 0) / kTileUnits,
                     std::min(max_x / kTileUnits, columns_ - 1), std::min(max_y / kTileUnits, rows_ - 1)};
    pending.small = max_x - min_x <= kSmall * kSub && max_y - min_y <= kSmall * kSub;
    pending_.push_back(pending);
  }

  void add_clipped(std::uint32_t id, const std::array<Vec3d, 3>& world) {
    const ClippedPolygon polygon = clip(projection_, world);
    for (std::size_t i = 2; i < polygon.count; ++i) {
      add(id, {polygon.corners[0], polygon.corners[i - 1], polygon.corners[i]});
    }
  }

  ChunkBins sorted() const {
    ChunkBins bins;
    if (pending_.empty()) return bins;
    TileRange all = pending_.front().tiles;
    for (const Pending& p : pending_) {
      all = {std::min(all.column0, p.tiles.column0), std::min(all.row0, p.tiles.row0),
             std::max(all.column1, p.tiles.column1), std::max(all.row1, p.tiles.row1)};
    }
    bins.first_column = all.column0;
    bins.first_row = all.row0;
    bins.columns = all.column1 - all.column0 + 1;
    bins.rows = all.row1 - all.row0 + 1;
    const std::size_t tiles = static_cast<std::size_t>(bins.columns) * static_cast<std::size_t>(bins.rows);
    bins.small_first.assign(tiles + 1, 0);
    bins.large_first.assign(static_cast<std::size_t>(bins.rows) + 1, 0);
    for (const Pending& p : pending_) {
      if (p.small) {
        for_each_tile(bins, p.tiles, [&](std::size_t tile, std::int32_t, std::int32_t) { ++bins.small_first[tile]; });
      } else {
        for_each_row(bins, p.tiles, [&](std::size_t row) { ++bins.large_first[row]; });
      }
    }
    bins.small.resize(to_offsets(bins.small_first));
    bins.large_of_row.resize(to_offsets(bins.large_first));
    std::vector<std::uint32_t> next_small = bins.small_first, next_large = bins.large_first;
    for (const Pending& p : pending_) {
      if (p.small) {
        for_each_tile(bins, p.tiles, [&](std::size_t tile, std::int32_t column, std::int32_t row) {
          bins.small[next_small[tile]++] = relative(p.triangle, column * kTile * kSub, row * kTile * kSub);
        });
      } else {
        const auto index = static_cast<std::uint32_t>(bins.large.size());
        bins.large.push_back(p.triangle);
        for_each_row(bins, p.tiles, [&](std::size_t row) { bins.large_of_row[next_large[row]++] = index; });
      }
    }
    return bins;
  }

 private:
  // Whether a sample's coordinate lies in [low, high].
  bool holds_sample(std::int32_t low, std::int32_t high) const {
    const std::int32_t shift = 2 * kGuard * kSub;  // makes it positive; a multiple of the step
    return (high - first_ + shift) / step_ * step_ >= low - first_ + shift;
  }

  template <class Body>
  static void for_each_tile(const ChunkBins& bins, const TileRange& tiles, Body&& body) {
    for (std::int32_t row = tiles.row0; row <= tiles.row1; ++row) {
      for (std::int32_t column = tiles.column0; column <= tiles.column1; ++column) {
        body(static_cast<std::size_t>((row - bins.first_row) * bins.columns + column - bins.first_column), column, row);
      }
    }
  }

  template <class Body>
  static void for_each_row(const ChunkBins& bins, const TileRange& tiles, Body&& body) {
    for (std::int32_t row = tiles.row0; row <= tiles.row1; ++row) body(static_cast<std::size_t>(row - bins.first_row));
  }

  static std::uint32_t to_offsets(std::vector<std::uint32_t>& counts) {
    std::uint32_t sum = 0;
    for (std::uint32_t& c : counts) sum += std::exchange(c, sum);
    return sum;
  }

  static SmallTriangle relative(const LargeTriangle& t, std::int32_t x, std::int32_t y) {
    SmallTriangle out;
    for (std::size_t k = 0; k < 3; ++k) {
      out.x[k] = static_cast<std::int16_t>(t.x[k] - x);
      out.y[k] = static_cast<std::int16_t>(t.y[k] - y);
    }
    out.nearness = t.nearness;
    out.id = t.id;
    return out;
  }

  const Projection& projection_;
  std::int32_t columns_, rows_, step_, first_;
  std::vector<Pending> pending_;
};

}  // namespace

SamplePattern SamplePattern::of(int samples) {
  SamplePattern pattern;
  pattern.count = samples;
  if (samples == 1) {
    pattern.x = {kSub / 2, kSub / 2 + kSub, kSub / 2 + 2 * kSub, kSub / 2 + 3 * kSub};
    pattern.y = {kSub / 2, kSub / 2, kSub / 2, kSub / 2};
  }
  return pattern;
}

Bins bin_triangles(const Projection& projection, const std::vector<Vec3d>& positions,
                   const std::vector<ScreenVertex>& vertices, const std::vector<Triangle>& triangles,
                   const SamplePattern& pattern, const Task& task) {
  Bins bins;
  bins.columns = static_cast<std::int32_t>((projection.width() + kTile - 1) / kTile);
  bins.rows = static_cast<std::int32_t>((projection.height() + kTile - 1) / kTile);
  const std::size_t chunk_size = std::max(kLeastChunk, (triangles.size() + kMostChunks - 1) / kMostChunks);
  bins.chunks.resize((triangles.size() + chunk_size - 1) / chunk_size);
  parallel_for(triangles.size(), chunk_size, task, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
    ChunkBinner binner(projection, pattern, bins.columns, bins.rows);
    for (std::size_t t = begin; t < end; ++t) {
      const auto id = static_cast<std::uint32_t>(t);
      const Triangle& names = triangles[t];
      const std::array<ScreenVertex, 3> v{vertices[names[0]], vertices[names[1]], vertices[names[2]]};
      if (v[0].outside() || v[1].outside() || v[2].outside()) {
        binner.add_clipped(id, {positions[names[0]], positions[names[1]], positions[names[2]]});
      } else {
        binner.add(id, v);
      }
    }
    bins.chunks[chunk] = binner.sorted();
  });
  return bins;
}

}  // namespace lodestone::render::detail
