#include "lodestone/voxel/edge_ratio.h"

#include <fmt/format.h>

#include <algorithm>

#include "lodestone/base/parallel.h"
#include "lodestone/core/validate.h"
#include "lodestone/voxel/cube_surface_detail.h"
#include "lodestone/voxel/resample.h"

namespace lodestone::voxel {

using detail::InsideRows;

namespace {

// Where the samples lie in the solid, in voxel_value()'s coordinates.
struct Lattice {
  Vec3d first;  // of sample (0, 0, 0)
  Vec3d ratio;  // small voxels from one to the next

  // Of the padded rows, whose layer takes one sample.
  Vec3d at(double x, double y, double z) const {
    return {first.x + (x - 1) * ratio.x, first.y + (y - 1) * ratio.y, first.z + (z - 1) * ratio.z};
  }
};

InsideRows sampled_rows(const BitVolume& solid, const std::array<std::uint32_t, 3>& samples, const Lattice& lattice,
                        double threshold, const Task& task) {
  InsideRows rows(samples[0], samples[1], samples[2]);
  parallel_for(samples[2], 1, task, [&](std::size_t slice, std::size_t, std::size_t) {
    const auto z = static_cast<std::uint32_t>(slice) + 1;
    for (std::uint32_t y = 1; y <= samples[1]; ++y) {
      std::uint64_t* bits = rows.bits(rows.row(y, z));
      for (std::uint32_t x = 1; x <= samples[0]; ++x) {
        if (voxel_value(solid, lattice.at(x, y, z)) > threshold) bits[x / 64] |= std::uint64_t{1} << (x % 64);
      }
    }
  });
  return rows;
}

// The march along one edge: its first point on the other side.
double edge_ratio(const BitVolume& solid, Vec3d from, Vec3d to, std::uint32_t steps, const EdgeRatioOptions& options) {
  const bool inside = voxel_value(solid, from) > options.threshold;
  const double step = 1.0 / steps;
  for (std::uint32_t i = 1; i <= steps; ++i) {
    const double t = i * step;
    if ((voxel_value(solid, from + (to - from) * t) > options.threshold) != inside) {
      return options.between_steps ? t - step / 2 : t;
    }
  }
  return 1;
}

}  // namespace

Result<Mesh> edge_ratio_surface(const BitVolume& solid, const std::array<std::uint32_t, 3>& samples,
                                const EdgeRatioOptions& options, Task task) {
  LODESTONE_TRY(validate(solid));
  Lattice lattice;
  VoxelGrid grid = solid.grid;
  std::array<std::uint32_t, 3> steps{};
  for (std::size_t k = 0; k < 3; ++k) {
    if (samples[k] < 1 || samples[k] > solid.grid.size[k]) {
      return fail(ErrorCode::bad_argument,
                  fmt::format("{} samples can't be taken of {} voxels", samples[k], solid.grid.size[k]), {},
                  "use 1 to as many as there are");
    }
    const double small = solid.grid.size[k];
    lattice.ratio[k] = small / samples[k];
    lattice.first[k] = options.from_first ? 0 : lattice.ratio[k] / 2 - 0.5;
    grid.size[k] = samples[k];
    grid.spacing[k] = solid.grid.spacing[k] * lattice.ratio[k];
    grid.origin[k] += solid.grid.spacing[k] * (lattice.first[k] + 0.5) - grid.spacing[k] / 2;
    const auto rounded = static_cast<std::uint32_t>(lattice.ratio[k] + 0.5);
    steps[k] = options.steps > 0 ? options.steps : std::max<std::uint32_t>(1, rounded);
  }
  if (!(options.threshold > 0 && options.threshold < 1)) {
    return fail(ErrorCode::bad_argument, fmt::format("a threshold of {} can't be", options.threshold), {},
                "use a value between 0 and 1");
  }
  const InsideRows rows = sampled_rows(solid, samples, lattice, options.threshold, task);
  const Result<detail::CubeSurface> surface = detail::find_surface(rows, task);
  LODESTONE_TRY(surface);
  if (surface->vertices == 0) return fail(ErrorCode::empty, "no sample lies inside");
  Mesh mesh;
  detail::place_vertices(grid, rows, *surface, mesh, task, [&](std::size_t axis, std::uint32_t y, std::uint32_t z) {
    return [&, axis, y, z](std::uint32_t x) {
      const Vec3d from = lattice.at(x, y, z);
      Vec3d to = from;
      to[axis] += lattice.ratio[axis];
      return edge_ratio(solid, from, to, steps[axis], options);
    };
  });
  detail::make_triangles(rows, *surface, mesh, task);
  if (task.cancelled()) return cancelled_error("contouring");
  return mesh;
}

}  // namespace lodestone::voxel
