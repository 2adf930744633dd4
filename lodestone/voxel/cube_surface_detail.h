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

/// Fills mesh.positions. share(axis, x, y, z) says where from the voxel (x, y, z) of the padded rows to the next along
/// the axis the vertex lies, 0 to 1; it is called from several threads.
template <class Share>
void place_vertices(const VoxelGrid& grid, const InsideRows& rows, const CubeSurface& surface, Mesh& mesh,
                    const Task& task, Share&& share) {
  mesh.offset = grid.point({grid.size[0] / 2.0, grid.size[1] / 2.0, grid.size[2] / 2.0});
  resize_large(mesh.positions, static_cast<std::size_t>(surface.vertices));
  parallel_for(rows.depth, 1, task, [&](std::size_t slice, std::size_t, std::size_t) {
    const auto z = static_cast<std::uint32_t>(slice);
    for (std::uint32_t y = 0; y < rows.height; ++y) {
      const std::size_t row = rows.row(y, z);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        std::uint32_t vertex = surface.first_vertex[axis][row];
        rows.for_each_crossed(axis, y, z, [&](std::uint32_t x) {
          Vec3d at{x - 0.5, y - 0.5, z - 0.5};  // the layer around takes one voxel
          at[axis] += share(axis, x, y, z);
          mesh.positions[vertex++] = to_float(grid.point(at) - mesh.offset);
        });
      }
    }
  });
}

}  // namespace lodestone::voxel::detail
