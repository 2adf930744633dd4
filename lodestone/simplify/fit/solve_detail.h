// One step of vertices towards where all correspondences are shortest.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lodestone/simplify/fit/correspondences_detail.h"

namespace lodestone::simplify::detail {

/// Corners around each vertex, 3 * triangle + corner: list[first[v] .. first[v + 1]).
struct CornersAt {
  std::vector<std::uint32_t> first, list;
};
CornersAt corners_at(const spatial::Surface& level);

/// Moves of the vertices, one each, zero where `no_move`. Gauss and Newton: each correspondence's partner is fixed, and
/// only the distance along the correspondence counts, so that the level may slide; damped by `damping` times the
/// correspondences' own weight at each vertex. The system of 3 x 3 blocks is solved by conjugate gradients,
/// preconditioned by its diagonal blocks. O(correspondences + steps * triangles).
std::vector<Vec3d> solve_displacements(const spatial::Surface& level, const Correspondences& correspondences,
                                       const CornersAt& around, std::span<const std::uint8_t> no_move, double damping,
                                       const Task& task);

/// Moves the vertices. Where a face would turn by more than some 70 degrees or fold onto a neighbour, the moves of its
/// vertices are halved a few times, and dropped if that does not help. The same where a face would turn away from where
/// it should look (`facing`, one a triangle): small steps must not add up. Vertices of triangles that would come to
/// cross do not move. Positions are rounded to floats relative to `offset`, as in a mesh.
void apply_displacements(spatial::Surface& level, const CornersAt& around, std::vector<Vec3d> moves,
                         std::span<const Vec3d> facing, Vec3d offset, const Task& task);

}  // namespace lodestone::simplify::detail
