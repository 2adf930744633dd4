// Where lines along z through the centres of voxels cross triangles.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "lodestone/base/task.h"
#include "lodestone/core/volume.h"
#include "lodestone/spatial/surface.h"

namespace lodestone::voxel::detail {

/// A vertex in voxel coordinates: x and y in units of 1/256 voxel, z in voxels.
struct GridVertex {
  std::int32_t x = 0, y = 0;
  float z = 0;
};

inline constexpr int kSubvoxelBits = 8;
inline constexpr std::int32_t kSubvoxel = 1 << kSubvoxelBits;

/// Far outside is brought to where no voxel is: crossings there count, which side they are on stays.
std::vector<GridVertex> grid_vertices(const spatial::Surface& surface, const VoxelGrid& grid, const Task& task);

/// Rows of voxels from first to end that one thread owns.
struct Band {
  std::uint32_t first = 0, end = 0;
  std::vector<std::uint32_t> triangles;  ///< that hold a centre of these rows in their box, by number
};

/// All triangles whose box in x and y holds a voxel's centre, by the bands that they reach.
std::vector<Band> bands_of(std::span<const GridVertex> vertices, std::span<const Triangle> triangles,
                           const VoxelGrid& grid, const Task& task);

/// First and last voxel whose centre lies in [least, largest), 1/256 voxels; nothing when first > last.
struct Centers {
  std::int32_t first, last;
};
inline Centers centers_between(std::int32_t least, std::int32_t largest, std::uint32_t size) {
  // The centre of voxel i is at 256 i + 128.
  const std::int32_t first = (least + kSubvoxel / 2 - 1) >> kSubvoxelBits,
                     last = (largest - kSubvoxel / 2 - 1) >> kSubvoxelBits;
  return {first > 0 ? first : 0,
          last < static_cast<std::int32_t>(size) - 1 ? last : static_cast<std::int32_t>(size) - 1};
}

/// Calls take(x, y, slice, sign) for each crossing with rows first to end of the grid: the line through column (x, y)
/// crosses the triangle just before the centre of voxel `slice` (0 to size z; beyond the grid is its nearer end).
/// Sign: 1 where the face looks to +z. Half open: a centre on an edge belongs to one of the two triangles beside it.
template <class Take>
void cross_columns(const GridVertex& a, const GridVertex& b, const GridVertex& c, const VoxelGrid& grid,
                   std::uint32_t first_row, std::uint32_t end_row, Take&& take) {
  const GridVertex* v[3] = {&a, &b, &c};
  const auto edge = [](const GridVertex& p, const GridVertex& q, std::int64_t x, std::int64_t y) {
    return (std::int64_t{q.x} - p.x) * (y - p.y) - (std::int64_t{q.y} - p.y) * (x - p.x);
  };
  const std::int64_t twice_area = edge(a, b, c.x, c.y);
  if (twice_area == 0) return;  // seen from its side: no line crosses it
  const int sign = twice_area > 0 ? 1 : -1;
  if (sign < 0) std::swap(v[1], v[2]);
  const Centers columns = centers_between(std::min({a.x, b.x, c.x}), std::max({a.x, b.x, c.x}) + 1, grid.size[0]);
  Centers rows = centers_between(std::min({a.y, b.y, c.y}), std::max({a.y, b.y, c.y}) + 1, grid.size[1]);
  rows.first = std::max(rows.first, static_cast<std::int32_t>(first_row));
  rows.last = std::min(rows.last, static_cast<std::int32_t>(end_row) - 1);
  // Edge k lies opposite to corner k. What lies on it is inside for edges that go down, or left along a row: of two
  // triangles beside an edge that holds for exactly one.
  std::int64_t step_x[3], step_y[3], at_row[3];
  const std::int64_t x0 = std::int64_t{columns.first} * kSubvoxel + kSubvoxel / 2;
  const std::int64_t y0 = std::int64_t{rows.first} * kSubvoxel + kSubvoxel / 2;
  for (std::size_t k = 0; k < 3; ++k) {
    const GridVertex &p = *v[(k + 1) % 3], &q = *v[(k + 2) % 3];
    const bool owns = q.y < p.y || (q.y == p.y && q.x < p.x);
    step_x[k] = -(std::int64_t{q.y} - p.y) * kSubvoxel;
    step_y[k] = (std::int64_t{q.x} - p.x) * kSubvoxel;
    at_row[k] = edge(p, q, x0, y0) - (owns ? 0 : 1);
  }
  const double inverse = 1.0 / static_cast<double>(twice_area > 0 ? twice_area : -twice_area);
  const double z0 = static_cast<double>(v[0]->z), z1 = static_cast<double>(v[1]->z), z2 = static_cast<double>(v[2]->z);
  const auto slices = static_cast<double>(grid.size[2]);
  for (std::int32_t y = rows.first; y <= rows.last; ++y) {
    std::int64_t e0 = at_row[0], e1 = at_row[1], e2 = at_row[2];
    for (std::int32_t x = columns.first; x <= columns.last; ++x) {
      if ((e0 | e1 | e2) >= 0) {
        // The rule's -1 is far below what matters for the depth.
        const double share1 = static_cast<double>(e1) * inverse, share2 = static_cast<double>(e2) * inverse;
        const double depth = z0 + (z1 - z0) * share1 + (z2 - z0) * share2;
        const double slice = std::ceil(depth - 0.5);
        take(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y),
             static_cast<std::uint32_t>(slice > 0 ? (slice < slices ? slice : slices) : 0.0), sign);
      }
      e0 += step_x[0];
      e1 += step_x[1];
      e2 += step_x[2];
    }
    for (std::size_t k = 0; k < 3; ++k) at_row[k] += step_y[k];
  }
}

struct Crossing {
  std::uint32_t column = 0;  ///< of the band: (row - first row) * width + x
  std::uint16_t slice = 0;   ///< as cross_columns() tells it
  std::int16_t sign = 0;
};

/// All crossings of a band's lines, column by column, each from its first slice on.
std::vector<Crossing> sorted_crossings(const spatial::Surface& surface, std::span<const GridVertex> vertices,
                                       const Band& band, const VoxelGrid& grid);

}  // namespace lodestone::voxel::detail
