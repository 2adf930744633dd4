// The surface between inside and outside voxels, cut by cubes: where it crosses the edges between them, each vertex
// with its number, and the triangles. Where on an edge a vertex lies is the caller's matter.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "lodestone/base/memory.h"
#include "lodestone/base/parallel.h"
#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/mesh.h"
#include "lodestone/core/volume.h"
#include "lodestone/voxel/inside_rows_detail.h"

namespace lodestone::voxel::detail {

/// Which edges are crossed and which cubes are cut.
struct CubeSurface {
  /// Number of the first vertex on the edges of each row, along x, y and z; one more at the end.
  std::array<std::vector<std::uint32_t>, 3> first_vertex;
  std::uint64_t vertices = 0;
  std::vector<std::vector<std::uint32_t>> cubes;  ///< a slice each: the cut ones, x * 256 + their corners inside
  std::vector<std::uint32_t> row_cubes;           ///< how many of them lie in each row
  std::vector<std::uint64_t> first_triangle;      ///< of each slice of cubes; one more at the end
};

/// Errors: cancelled, unsupported (more vertices than a mesh can name).
Result<CubeSurface> find_surface(const InsideRows& rows, const Task& task);

/// Fills mesh.triangles.
void make_triangles(const InsideRows& rows, const CubeSurface& surface, Mesh& mesh, const Task& task);

/// Fills mesh.positions. shares_of(axis, y, z) gives, for the row of edges that begin at voxels (x, y, z) of the padded
/// rows, what says for each x where from there to the next voxel the vertex lies, 0 to 1. Called from several threads.
template <class SharesOf>
void place_vertices(const VoxelGrid& grid, const InsideRows& rows, const CubeSurface& surface, Mesh& mesh,
                    const Task& task, SharesOf&& shares_of) {
  mesh.offset = grid.point({grid.size[0] / 2.0, grid.size[1] / 2.0, grid.size[2] / 2.0});
  resize_large(mesh.positions, static_cast<std::size_t>(surface.vertices));
  parallel_for(rows.depth - 1, 1, task, [&](std::size_t slice, std::size_t, std::size_t) {
    const auto z = static_cast<std::uint32_t>(slice);
    for (std::uint32_t y = 0; y + 1 < rows.height; ++y) {
      const std::size_t row = rows.row(y, z);
      if (surface.row_cubes[row] == 0) continue;
      const Vec3d start = grid.point({-0.5, y - 0.5, z - 0.5}) - mesh.offset;  // the layer around takes one voxel
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto share = shares_of(axis, y, z);
        Vec3f* out = mesh.positions.data() + surface.first_vertex[axis][row];
        rows.for_each_crossed(axis, y, z, [&](std::uint32_t x) {
          Vec3d at = start;
          at.x += x * grid.spacing.x;
          at[axis] += share(x) * grid.spacing[axis];
          *out++ = to_float(at);
        });
      }
    }
  });
}

}  // namespace lodestone::voxel::detail
