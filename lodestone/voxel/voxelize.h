// Solid voxelization: which voxels' centres lie inside a surface.
#pragma once

#include <array>
#include <cstdint>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/input.h"
#include "lodestone/core/volume.h"
#include "lodestone/math/box.h"
#include "lodestone/spatial/surface.h"

namespace lodestone::voxel {

/// What counts as inside, along a line through the voxel's centre.
enum class FillRule {
  parity,   ///< an odd number of crossings before it: closed surfaces, hollow ones stay hollow
  nonzero,  ///< more ways in than out, or the other way round: overlapping closed pieces with their faces outward
  /// A generalised winding number above a half, either way round: open surfaces, whose holes are closed by what seems
  /// most inside. Between crossings it is looked up at both ends and in the middle, and wherever these leave a doubt.
  winding,
  /// What can't be reached from outside once the surface is grown by a radius: holes up to twice of it are closed,
  /// hollows filled (shrinkwrap() in surface_voxels.h).
  shrinkwrap,
};

struct VoxelizeOptions {
  FillRule fill = FillRule::parity;
  double close_voxels = 2;         ///< shrinkwrap: the radius, voxels
  Input input = Input::unchecked;  ///< of the surface
};

struct VoxelizeSeconds {
  double slicing = 0, filling = 0;
};

struct Voxelized {
  BitVolume volume;
  /// Columns along z on whose far side the line was still inside: above 0 for surfaces that aren't closed.
  std::uint64_t leaking_columns = 0;
  VoxelizeSeconds seconds;
};

/// A grid whose longest side has `resolution` voxels, `margin` of them empty on every side of `bounds`; voxels are
/// cubes. Flat bounds get at least one voxel. Errors: bad_argument (resolution not above twice the margin, bounds that
/// are not finite or a point).
Result<VoxelGrid> grid_around(const Box3d& bounds, std::uint32_t resolution, std::uint32_t margin = 1);

/// A grid of just these counts whose voxels fill `bounds` exactly, as [voxel-lod] takes it (section 2.3); voxels may
/// have any aspect. Errors as above.
Result<VoxelGrid> grid_over(const Box3d& bounds, const std::array<std::uint32_t, 3>& resolution);

/// Solid voxels of a surface by crossings along z. Vertices are rounded to 1/256 voxel in x and y, where all decisions
/// are whole-number ones: a line through a vertex or along an edge meets exactly one of the triangles beside it (the
/// half-open rule, in place of the nudging of [voxel-lod], section 2.3.3), so a closed surface never leaks. The depth
/// of a crossing is in single precision. Same bits for any thread count. O(triangles + voxels / 64), memory an eighth
/// of a byte a voxel and some 12 bytes a triangle, with `nonzero` 8 more a crossing; `winding`: some microseconds for
/// each of three voxels or so between two crossings. Errors: bad_argument (a grid without voxels, or with sides above
/// 65,535; those of validate()), cancelled.
Result<Voxelized> voxelize(const spatial::Surface& surface, const VoxelGrid& grid, const VoxelizeOptions& options = {},
                           Task task = {});

}  // namespace lodestone::voxel
