// Which voxels' centres lie inside a surface.
//
// Source: [voxel-lod], sections 2.3.2 and 2.3.3 (slices, then scanlines in each). Here the scanlines are lines along z
// through all voxels' centres, and all slices are made at once; docs/papers/voxel.md says why.
// 1. toggle_crossings(), fill_parity(): for closed surfaces a bit at the first voxel after each crossing, then every
//    slice XORed with the one before, 64 voxels in a word.
// 2. fill_nonzero(): for several closed pieces that overlap the crossings of a line are sorted, and their signs summed.
// 3. leaking_lines(): lines that are still inside after their last crossing, as those of open surfaces are.
// 4. grid_around(), grid_over(): grids for a box.
// 5. voxelize(): picks the rule. Open surfaces go to fill_winding.cpp, holes to be closed by a radius to shrinkwrap().
// Invariants: whether a line crosses a triangle is decided in whole numbers (z_crossings_detail.h), and a line through
// an edge or a vertex meets exactly one of the triangles beside it, so a closed surface never leaks. Bands of rows
// belong to one thread each: the same bits for any thread count. Cost: O(triangles + crossings + voxels / 64).
#include "lodestone/voxel/voxelize.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "lodestone/base/parallel.h"
#include "lodestone/base/stopwatch.h"
#include "lodestone/core/validate.h"
#include "lodestone/voxel/fill_winding_detail.h"
#include "lodestone/voxel/surface_voxels.h"
#include "lodestone/voxel/z_crossings_detail.h"

namespace lodestone::voxel {

using detail::Band;
using detail::Crossing;
using detail::GridVertex;

namespace {

constexpr std::uint32_t kMostSide = 65'535;

Result<void> check(const VoxelGrid& grid) {
  for (const std::uint32_t n : grid.size) {
    if (n >= 1 && n <= kMostSide) continue;
    return fail(ErrorCode::bad_argument,
                fmt::format("a volume of {} x {} x {} voxels can't be made", grid.size[0], grid.size[1], grid.size[2]),
                {}, fmt::format("each side must have 1 to {}", kMostSide));
  }
  return {};
}

Result<void> check(const Box3d& bounds) {
  const Vec3d size = bounds.size();
  const double longest = std::max({size.x, size.y, size.z});
  if (std::isfinite(longest) && longest > 0) return {};
  return fail(ErrorCode::bad_argument, "the model has no extent that could be cut into voxels");
}

// A bit at the first voxel after each crossing; those beyond the last slice go to `beyond`.
void toggle_crossings(const spatial::Surface& surface, const std::vector<GridVertex>& vertices,
                      const std::vector<Band>& bands, BitVolume& volume, BitVolume& beyond, const Task& task) {
  const std::uint32_t slices = volume.grid.size[2];
  parallel_for(bands.size(), 1, task, [&](std::size_t i, std::size_t, std::size_t) {
    const Band& band = bands[i];
    for (const std::uint32_t t : band.triangles) {
      const Triangle& c = surface.triangles[t];
      detail::cross_columns(vertices[c[0]], vertices[c[1]], vertices[c[2]], volume.grid, band.first, band.end,
                            [&](std::uint32_t x, std::uint32_t y, std::uint32_t slice, int) {
                              std::uint64_t& word = slice < slices ? volume.words[volume.row_of(y, slice) + x / 64]
                                                                   : beyond.words[beyond.row_of(y, 0) + x / 64];
                              word ^= std::uint64_t{1} << (x % 64);
                            });
    }
  });
}

// Each slice becomes the XOR of all up to it.
void fill_parity(BitVolume& volume, const Task& task) {
  const std::size_t slice = volume.row_words * volume.grid.size[1];
  constexpr std::size_t kWords = 512;
  parallel_for(slice, kWords, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t z = 1; z < volume.grid.size[2]; ++z) {
      std::uint64_t* here = volume.words.data() + z * slice;
      const std::uint64_t* before = here - slice;
      for (std::size_t w = begin; w < end; ++w) here[w] ^= before[w];
    }
  });
}

// The voxels between crossings. Returns the lines that end inside.
std::uint64_t fill_nonzero(const spatial::Surface& surface, const std::vector<GridVertex>& vertices,
                           const std::vector<Band>& bands, BitVolume& volume, const Task& task) {
  const std::uint32_t width = volume.grid.size[0];
  std::vector<std::uint64_t> leaking(bands.size(), 0);
  parallel_for(bands.size(), 1, task, [&](std::size_t i, std::size_t, std::size_t) {
    const Band& band = bands[i];
    const std::vector<Crossing> crossings = detail::sorted_crossings(surface, vertices, band, volume.grid);
    int winding = 0;
    for (std::size_t k = 0; k < crossings.size(); ++k) {
      const Crossing& here = crossings[k];
      winding = k > 0 && crossings[k - 1].column == here.column ? winding + here.sign : here.sign;
      const bool last = k + 1 == crossings.size() || crossings[k + 1].column != here.column;
      const std::uint32_t end = last ? volume.grid.size[2] : crossings[k + 1].slice;
      if (winding == 0) continue;
      if (last) ++leaking[i];
      const std::uint32_t x = here.column % width, y = band.first + here.column / width;
      for (std::uint32_t z = here.slice; z < end; ++z) volume.set(x, y, z);
    }
  });
  return std::accumulate(leaking.begin(), leaking.end(), std::uint64_t{0});
}

// Lines that are inside after their last crossing.
std::uint64_t leaking_lines(const BitVolume& volume, const BitVolume& beyond) {
  std::uint64_t count = 0;
  const std::size_t last = volume.row_of(0, volume.grid.size[2] - 1);
  for (std::size_t w = 0; w < beyond.words.size(); ++w) {
    count += static_cast<std::uint64_t>(std::popcount(volume.words[last + w] ^ beyond.words[w]));
  }
  return count;
}

}  // namespace

Result<VoxelGrid> grid_around(const Box3d& bounds, std::uint32_t resolution, std::uint32_t margin) {
  LODESTONE_TRY(check(bounds));
  if (resolution > kMostSide || std::uint64_t{resolution} <= 2 * std::uint64_t{margin}) {
    return fail(ErrorCode::bad_argument, fmt::format("a resolution of {} can't be", resolution), {},
                fmt::format("use {} to {}", 2 * std::uint64_t{margin} + 1, kMostSide));
  }
  const Vec3d size = bounds.size();
  const double side = std::max({size.x, size.y, size.z}) / (resolution - 2 * margin);
  VoxelGrid grid;
  grid.spacing = {side, side, side};
  for (std::size_t k = 0; k < 3; ++k) {
    const double inner = std::max(1.0, std::ceil(size[k] / side - 1e-9));
    grid.size[k] = std::min(resolution, static_cast<std::uint32_t>(inner) + 2 * margin);
    grid.origin[k] = bounds.center()[k] - side * grid.size[k] / 2;
  }
  return grid;
}

Result<VoxelGrid> grid_over(const Box3d& bounds, const std::array<std::uint32_t, 3>& resolution) {
  LODESTONE_TRY(check(bounds));
  VoxelGrid grid;
  grid.size = resolution;
  LODESTONE_TRY(check(grid));
  const Vec3d size = bounds.size();
  const double longest = std::max({size.x, size.y, size.z});
  grid.origin = bounds.min;
  for (std::size_t k = 0; k < 3; ++k) grid.spacing[k] = (size[k] > 0 ? size[k] : longest) / resolution[k];
  return grid;
}

Result<Voxelized> voxelize(const spatial::Surface& surface, const VoxelGrid& grid, const VoxelizeOptions& options,
                           Task task) {
  LODESTONE_TRY(check(grid));
  LODESTONE_TRY(validate(grid));
  if (options.input != Input::valid) {
    LODESTONE_TRY(validate(surface, task));
  }
  Stopwatch watch;
  Voxelized out;
  if (options.fill == FillRule::shrinkwrap) {
    Result<BitVolume> wrapped = shrinkwrap(surface, grid, options.close_voxels, task);
    LODESTONE_TRY(wrapped);
    out.volume = std::move(*wrapped);
    out.seconds.filling = watch.lap();
    return out;
  }
  out.volume = BitVolume(grid);
  if (options.fill == FillRule::winding) {
    detail::fill_winding(surface, out.volume, task);
    if (task.cancelled()) return cancelled_error("voxelizing");
    out.seconds.filling = watch.lap();
    return out;
  }
  const std::vector<GridVertex> vertices = detail::grid_vertices(surface, grid, task);
  const std::vector<Band> bands = detail::bands_of(vertices, surface.triangles, grid, task);
  if (options.fill == FillRule::parity) {
    VoxelGrid last = grid;
    last.size[2] = 1;
    BitVolume beyond(last);
    toggle_crossings(surface, vertices, bands, out.volume, beyond, task);
    out.seconds.slicing = watch.lap();
    fill_parity(out.volume, task);
    out.leaking_columns = leaking_lines(out.volume, beyond);
  } else {
    out.seconds.slicing = watch.lap();
    out.leaking_columns = fill_nonzero(surface, vertices, bands, out.volume, task);
  }
  if (task.cancelled()) return cancelled_error("voxelizing");
  out.seconds.filling = watch.lap();
  return out;
}

}  // namespace lodestone::voxel
