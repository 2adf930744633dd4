#include "lodestone/voxel/slab_surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "lodestone/base/parallel.h"
#include "lodestone/base/stopwatch.h"
#include "lodestone/core/validate.h"
#include "lodestone/voxel/cube_surface_detail.h"
#include "lodestone/voxel/resample.h"

namespace lodestone::voxel {

using detail::InsideRows;

namespace {

constexpr std::uint64_t kSlabBytes = std::uint64_t{64} << 20;

Result<void> check(const VoxelGrid& grid, const std::array<std::uint32_t, 3>& size, const VoxelizeOptions& options) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (size[k] >= 1 && grid.size[k] % size[k] == 0) continue;
    return fail(ErrorCode::bad_argument, fmt::format("{} voxels are no whole multiple of {}", grid.size[k], size[k]));
  }
  if (options.fill != FillRule::shrinkwrap) return {};
  return fail(ErrorCode::bad_argument, "shrinkwrap can't work on so many voxels", {}, "lower `resolution`");
}

// One place on for the layer around.
void set_row_from_bits(const std::uint64_t* from, std::size_t words, std::uint64_t* to, std::size_t to_words) {
  std::uint64_t carried = 0;
  for (std::size_t w = 0; w < words; ++w) {
    to[w] = from[w] << 1 | carried;
    carried = from[w] >> 63;
  }
  if (words < to_words) to[words] = carried;
}

void set_row_from_shares(const std::uint8_t* shares, std::uint32_t count, std::uint64_t* to) {
  for (std::uint32_t x = 0; x < count; ++x) {
    if (shares[x] >= 128) to[(x + 1) / 64] |= std::uint64_t{1} << ((x + 1) % 64);
  }
}

// The rows of slices z and on, from a slab of the solid.
Result<void> take_slab(const BitVolume& solid, std::uint32_t ratio_z, std::uint32_t z, InsideRows& rows,
                       const std::array<std::uint32_t, 3>& size, const Task& task) {
  const std::uint32_t slices = solid.grid.size[2] / ratio_z;
  const bool same = solid.grid.size[0] == size[0] && solid.grid.size[1] == size[1] && ratio_z == 1;
  std::optional<ScalarVolume<std::uint8_t>> shares;
  if (!same) {
    Result<ScalarVolume<std::uint8_t>> made = downsample(solid, {size[0], size[1], slices}, task);
    LODESTONE_TRY(made);
    shares = std::move(*made);
  }
  parallel_for(slices, 1, task, [&](std::size_t slice, std::size_t, std::size_t) {
    const auto s = static_cast<std::uint32_t>(slice);
    for (std::uint32_t y = 0; y < size[1]; ++y) {
      std::uint64_t* to = rows.bits(rows.row(y + 1, z + s + 1));
      if (same) {
        set_row_from_bits(solid.words.data() + solid.row_of(y, s), solid.row_words, to, rows.row_words);
      } else {
        set_row_from_shares(shares->values.data() + shares->index(0, y, s), size[0], to);
      }
    }
  });
  if (task.cancelled()) return cancelled_error("voxelizing");
  return {};
}

}  // namespace

Result<SlabSurface> slab_surface(const spatial::Surface& surface, const VoxelGrid& grid,
                                 const std::array<std::uint32_t, 3>& size, const VoxelizeOptions& options, Task task) {
  LODESTONE_TRY(check(grid, size, options));
  LODESTONE_TRY(validate(grid));
  if (options.input != Input::valid) {
    LODESTONE_TRY(validate(surface, task));
  }
  VoxelizeOptions of_slab = options;
  of_slab.input = Input::valid;
  SlabSurface out;
  Stopwatch watch;
  InsideRows rows(size[0], size[1], size[2]);
  const std::uint32_t ratio = grid.size[2] / size[2];
  const std::uint64_t slice_bytes = (grid.size[0] / 64 + 1) * 8 * std::uint64_t{grid.size[1]} * ratio;
  const auto slices = static_cast<std::uint32_t>(std::clamp<std::uint64_t>(kSlabBytes / slice_bytes, 1, size[2]));
  for (std::uint32_t z = 0; z < size[2]; z += slices) {
    // A grid that begins further on: crossings before it turn its first slice on, so each slab stands for itself.
    VoxelGrid slab = grid;
    const std::uint32_t first = z * ratio;
    slab.size[2] = std::min(slices, size[2] - z) * ratio;
    slab.origin.z += grid.spacing.z * first;
    watch.lap();
    const Result<Voxelized> made = voxelize(surface, slab, of_slab, task);
    LODESTONE_TRY(made);
    out.voxelize_seconds += watch.lap();
    out.voxels_inside += made->volume.set_count();
    if (z + slices >= size[2]) out.leaking_columns = made->leaking_columns;
    LODESTONE_TRY(take_slab(made->volume, ratio, z, rows, size, task));
    out.resample_seconds += watch.lap();
    task.advance(0.7 * slices / size[2]);
  }
  const Result<detail::CubeSurface> found = detail::find_surface(rows, task);
  LODESTONE_TRY(found);
  if (found->vertices == 0) return fail(ErrorCode::empty, "no voxel is inside");
  VoxelGrid level = grid;
  level.size = size;
  for (std::size_t k = 0; k < 3; ++k) level.spacing[k] = grid.spacing[k] * grid.size[k] / size[k];
  detail::place_vertices(level, rows, *found, out.mesh, task,
                         [](std::size_t, std::uint32_t, std::uint32_t) { return [](std::uint32_t) { return 0.5; }; });
  detail::make_triangles(rows, *found, out.mesh, task);
  if (task.cancelled()) return cancelled_error("contouring");
  out.isosurface_seconds = watch.lap();
  return out;
}

}  // namespace lodestone::voxel
