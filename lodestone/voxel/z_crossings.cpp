#include <algorithm>

#include "lodestone/base/parallel.h"
#include "lodestone/voxel/z_crossings_detail.h"

namespace lodestone::voxel::detail {

namespace {

constexpr std::size_t kChunk = std::size_t{1} << 14;
constexpr std::uint32_t kMostBands = 32;

// Products of two differences stay below 2^63.
constexpr double kFar = 1 << 29;

std::int32_t whole(double x) {
  const double rounded = std::floor(x * kSubvoxel + 0.5);
  return static_cast<std::int32_t>(std::clamp(rounded, -kFar, kFar));
}

}  // namespace

std::vector<GridVertex> grid_vertices(const spatial::Surface& surface, const VoxelGrid& grid, const Task& task) {
  std::vector<GridVertex> out(surface.positions.size());
  parallel_for(out.size(), kChunk, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3d p = surface.positions[i] - grid.origin;
      out[i] = {whole(p.x / grid.spacing.x), whole(p.y / grid.spacing.y), static_cast<float>(p.z / grid.spacing.z)};
    }
  });
  return out;
}

std::vector<Band> bands_of(std::span<const GridVertex> vertices, std::span<const Triangle> triangles,
                           const VoxelGrid& grid, const Task& task) {
  const std::uint32_t rows = grid.size[1], height = (rows + kMostBands - 1) / kMostBands;
  const std::uint32_t count = (rows + height - 1) / height;
  const std::size_t chunks = (triangles.size() + kChunk - 1) / kChunk;
  std::vector<std::vector<std::uint32_t>> found(chunks * count);
  parallel_for(triangles.size(), kChunk, task, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
    for (std::size_t t = begin; t < end; ++t) {
      const GridVertex &a = vertices[triangles[t][0]], &b = vertices[triangles[t][1]], &c = vertices[triangles[t][2]];
      const Centers x = centers_between(std::min({a.x, b.x, c.x}), std::max({a.x, b.x, c.x}) + 1, grid.size[0]);
      const Centers y = centers_between(std::min({a.y, b.y, c.y}), std::max({a.y, b.y, c.y}) + 1, grid.size[1]);
      if (x.first > x.last || y.first > y.last) continue;
      const auto first = static_cast<std::uint32_t>(y.first) / height,
                 last = static_cast<std::uint32_t>(y.last) / height;
      for (std::uint32_t band = first; band <= last; ++band) {
        found[chunk * count + band].push_back(static_cast<std::uint32_t>(t));
      }
    }
  });
  std::vector<Band> bands(count);
  parallel_for(count, 1, task, [&](std::size_t band, std::size_t, std::size_t) {
    bands[band].first = static_cast<std::uint32_t>(band) * height;
    bands[band].end = std::min(rows, bands[band].first + height);
    for (std::size_t chunk = 0; chunk < chunks; ++chunk) {
      const auto& part = found[chunk * count + band];
      bands[band].triangles.insert(bands[band].triangles.end(), part.begin(), part.end());
    }
  });
  return bands;
}

std::vector<Crossing> sorted_crossings(const spatial::Surface& surface, std::span<const GridVertex> vertices,
                                       const Band& band, const VoxelGrid& grid) {
  std::vector<Crossing> crossings;
  for (const std::uint32_t t : band.triangles) {
    const Triangle& c = surface.triangles[t];
    cross_columns(vertices[c[0]], vertices[c[1]], vertices[c[2]], grid, band.first, band.end,
                  [&](std::uint32_t x, std::uint32_t y, std::uint32_t slice, int sign) {
                    crossings.push_back({(y - band.first) * grid.size[0] + x, static_cast<std::uint16_t>(slice),
                                         static_cast<std::int16_t>(sign)});
                  });
  }
  std::sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) {
    return a.column != b.column ? a.column < b.column : a.slice < b.slice;
  });
  return crossings;
}

}  // namespace lodestone::voxel::detail
