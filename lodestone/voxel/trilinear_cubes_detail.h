// Cubes as the trilinear interpolant of their corners has them: which corners a face joins, and tunnels.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "lodestone/base/task.h"
#include "lodestone/core/mesh.h"
#include "lodestone/voxel/cube_surface_detail.h"
#include "lodestone/voxel/inside_rows_detail.h"

namespace lodestone::voxel::detail {

/// Values of a cube's corners less the iso value: above 0 is inside.
using CornerValues = std::array<double, 8>;

/// How the surface passes through a cube.
struct TrilinearCube {
  std::vector<std::vector<std::uint8_t>> loops;  ///< rings of crossed edges, as in CubeLoops
  bool tunnel = false;                           ///< two rings that bound one piece of the surface, a tube
};

/// Faces whose inside corners lie opposite join them where the bilinear interpolant does (the asymptotic decider of
/// G. Nielson and B. Hamann, IEEE Visualization 1991). Two rings are one tube where a saddle inside the cube joins what
/// they part (E. Chernyaev, Marching Cubes 33, CERN 1995). With three rings or more each is taken for a piece of its
/// own.
TrilinearCube trilinear_cube(const CornerValues& values);

/// True where that may differ from the table: a face's inside corners lie opposite, or the cube's.
bool is_ambiguous(unsigned corners);

/// Gives the values around a cube of the padded rows.
using ValuesAt = std::function<CornerValues(std::uint32_t x, std::uint32_t y, std::uint32_t z)>;

/// As make_triangles(), with ambiguous cubes by trilinear_cube(). Adds vertices to mesh.positions, in the middle of
/// rings and of tubes.
void make_trilinear_triangles(const InsideRows& rows, const CubeSurface& surface, const ValuesAt& values_at, Mesh& mesh,
                              const Task& task);

}  // namespace lodestone::voxel::detail
