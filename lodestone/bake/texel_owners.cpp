#include <algorithm>
#include <array>
#include <cmath>

#include "lodestone/bake/texel_owners_detail.h"
#include "lodestone/base/parallel.h"
#include "lodestone/math/triangle.h"

namespace lodestone::bake::detail {

namespace {

constexpr std::size_t kChunk = 16384;
constexpr double kRounding = 1e-12;  // of squared distances, texels: not farther is covered

struct Range {
  std::uint32_t x0, y0, x1, y1;  // the end is not part of it
};

// A triangle in texels, z = 0.
struct Flat {
  std::array<Vec3d, 3> corner;

  Flat(const Triangle& wedges, const std::vector<float>& uv, std::uint32_t size) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t w = std::size_t{wedges[k]} * 2;
      corner[k] = {double(uv[w]) * size, double(uv[w + 1]) * size, 0};
    }
  }

  // The texels whose centres may be within reach; none where a coordinate is no number.
  Range range(double reach, std::uint32_t size) const {
    const auto at = [&](double t) {
      return static_cast<std::uint32_t>(t > 0 ? std::min(t, static_cast<double>(size)) : 0.0);
    };
    const auto [low_x, high_x] = std::minmax({corner[0].x, corner[1].x, corner[2].x});
    const auto [low_y, high_y] = std::minmax({corner[0].y, corner[1].y, corner[2].y});
    if (!std::isfinite(high_x - low_x) || !std::isfinite(high_y - low_y)) return {0, 0, 0, 0};
    return {at(std::ceil(low_x - reach - 0.5)), at(std::ceil(low_y - reach - 0.5)),
            at(std::floor(high_x + reach + 0.5)), at(std::floor(high_y + reach + 0.5))};
  }
};

// The triangles that may reach into each tile, by rising number: list[first[tile] .. first[tile + 1]).
struct Bins {
  std::vector<std::uint32_t> first, list;
};

Bins sort_into_tiles(const std::vector<Range>& ranges, const Tiles& tiles) {
  Bins bins;
  bins.first.assign(tiles.count() + 1, 0);
  const auto each = [&](auto&& use) {
    for (std::uint32_t t = 0; t < ranges.size(); ++t) {
      const Range& r = ranges[t];
      if (r.x0 >= r.x1 || r.y0 >= r.y1) continue;
      for (std::uint32_t y = r.y0 / Tiles::kSide; y <= (r.y1 - 1) / Tiles::kSide; ++y) {
        for (std::uint32_t x = r.x0 / Tiles::kSide; x <= (r.x1 - 1) / Tiles::kSide; ++x) {
          use(std::size_t{y} * tiles.per_row() + x, t);
        }
      }
    }
  };
  each([&](std::size_t tile, std::uint32_t) { ++bins.first[tile]; });
  bins.list.resize(exclusive_scan(bins.first));
  std::vector<std::uint32_t> next(bins.first.begin(), bins.first.end() - 1);
  each([&](std::size_t tile, std::uint32_t t) { bins.list[next[tile]++] = t; });
  return bins;
}

}  // namespace

std::vector<TexelOwner> texel_owners(const Mesh& mesh, const std::vector<float>& uv, std::uint32_t size, double reach,
                                     const Task& task) {
  const Tiles tiles{size};
  std::vector<Range> ranges(mesh.triangles.size());
  parallel_for(ranges.size(), kChunk, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t t = begin; t < end; ++t) ranges[t] = Flat(mesh.triangles[t], uv, size).range(reach, size);
  });
  const Bins bins = sort_into_tiles(ranges, tiles);
  std::vector<TexelOwner> owners(std::size_t{size} * size);
  parallel_for(tiles.count(), 1, task, [&](std::size_t tile, std::size_t, std::size_t) {
    const auto tile_x = static_cast<std::uint32_t>(tile % tiles.per_row()) * Tiles::kSide;
    const auto tile_y = static_cast<std::uint32_t>(tile / tiles.per_row()) * Tiles::kSide;
    for (std::uint32_t i = bins.first[tile]; i < bins.first[tile + 1]; ++i) {
      const std::uint32_t t = bins.list[i];
      const Flat flat(mesh.triangles[t], uv, size);
      const Range& r = ranges[t];
      for (std::uint32_t y = std::max(r.y0, tile_y); y < std::min(r.y1, tile_y + Tiles::kSide); ++y) {
        for (std::uint32_t x = std::max(r.x0, tile_x); x < std::min(r.x1, tile_x + Tiles::kSide); ++x) {
          TexelOwner& owner = owners[std::size_t{y} * size + x];
          if (owner.triangle != kNone && owner.distance_sq <= 0) continue;
          const auto& [a, b, c] = flat.corner;
          const ClosestPoint found = closest_point({x + 0.5, y + 0.5, 0}, a, b, c);
          const float distance_sq = found.distance_sq > kRounding ? static_cast<float>(found.distance_sq) : 0.0F;
          if (!(found.distance_sq <= reach * reach)) continue;
          if (owner.triangle != kNone && owner.distance_sq <= distance_sq) continue;
          owner = {t, distance_sq};
        }
      }
    }
  });
  return owners;
}

spatial::SurfacePoint place_in_texture(const Mesh& mesh, const std::vector<float>& uv, std::uint32_t size,
                                       std::uint32_t triangle, Vec2d texel) {
  const auto [a, b, c] = Flat(mesh.triangles[triangle], uv, size).corner;
  const std::array<double, 3> weights = barycentric(closest_point({texel.x, texel.y, 0}, a, b, c).point, a, b, c);
  return {triangle, weights[1], weights[2]};
}

}  // namespace lodestone::bake::detail
