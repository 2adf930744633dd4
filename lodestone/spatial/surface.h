// Surface: everything that a model draws, as one soup of triangles in world space.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/input.h"
#include "lodestone/core/mesh.h"
#include "lodestone/core/model.h"
#include "lodestone/math/box.h"

namespace lodestone::spatial {

/// Triangles along a Hilbert curve of their centres, vertices in the order in which these name them first, so that
/// neighbours in space are neighbours in memory. Vertices are not shared between instances.
struct Surface {
  std::vector<Vec3d> positions;     ///< world space
  std::vector<Triangle> triangles;  ///< indices into positions
  /// Each triangle's number among all that the scene draws, instance after instance: the way back to its attributes.
  std::vector<std::uint32_t> drawn;
  Box3d bounds;

  std::array<Vec3d, 3> corners(std::size_t triangle) const {
    const Triangle& t = triangles[triangle];
    return {positions[t[0]], positions[t[1]], positions[t[2]]};
  }
};

/// Flattens the default scene: all instances, bind pose; a mirrored instance keeps its faces outward (its second
/// and third corners change places). O(n log n).
/// Errors: bad_argument (those of validate()), empty, unsupported (more triangles than can be numbered), cancelled.
Result<Surface> flatten(const Model& model, Task task = {});
Result<Surface> flatten(const Model& model, Input input, Task task = {});

/// Whether all triangles name positions that exist, and these are finite and within kMostCoordinate. O(n). Errors:
/// bad_argument, cancelled.
Result<void> validate(const Surface& surface, const Task& task = {});

}  // namespace lodestone::spatial
