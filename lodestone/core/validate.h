// What must hold for every Mesh, Model, Ladder, PointCloud and volume, so that no operation has to ask again.
//
// Operations that return a Result validate what they are given, once and before any work; those that are called again
// and again take an Input by which callers that know better spare that. Functions that return plain values take what is
// valid.
#pragma once

#include <cstdint>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/collapse_log.h"
#include "lodestone/core/input.h"
#include "lodestone/core/level.h"
#include "lodestone/core/mesh.h"
#include "lodestone/core/model.h"
#include "lodestone/core/pixels.h"
#include "lodestone/core/point_cloud.h"
#include "lodestone/core/scanned_volume.h"
#include "lodestone/core/volume.h"

namespace lodestone {

/// No coordinate of what is drawn may be larger than this, model units, so that squares of distances are finite.
inline constexpr double kMostCoordinate = 1e150;

/// Checks indices in range, stream sizes, group indices, finite positions and offset. One pass, on threads. O(size).
/// Errors: bad_argument naming the first offender and the limit, `where` is the mesh's name; cancelled.
Result<void> validate(const Mesh& mesh, const Task& task = {});

/// The same without looking at positions and offset. O(size) as well.
Result<void> validate_indices(const Mesh& mesh, const Task& task = {});

/// All meshes; materials that groups name (any, in a model that has none: they are drawn white) and their pixels;
/// meshes that instances name; transforms, which are finite and take positions no farther than kMostCoordinate. Errors:
/// bad_argument, `where` is "mesh 2 (its name)", "material 0 (…)" or "instance 1 (…)"; cancelled.
Result<void> validate(const Model& model, const Task& task = {});

/// The original and all levels, of which there is at least the first. Errors: as above, `where` begins with "level 2".
Result<void> validate(const Ladder& ladder, const Task& task = {});

/// Positions and offset are finite; normals and colours one a point, or none. O(points). Errors: bad_argument,
/// cancelled.
Result<void> validate(const PointCloud& cloud, const Task& task = {});

/// As many bytes as width and height need. O(1). Errors: bad_argument.
Result<void> validate(const Pixels& pixels);

/// Spacings above 0, all numbers finite, fewer than 2^64 voxels. Errors: bad_argument.
Result<void> validate(const VoxelGrid& grid);

/// The grid, and that there are as many words as it needs. O(1). Errors: bad_argument.
Result<void> validate(const BitVolume& volume);

/// The grid, and that there are at least as many values as voxels. O(1). Errors: bad_argument.
Result<void> validate(const VoxelGrid& grid, std::uint64_t values);
template <class T>
Result<void> validate(const VolumeView<T>& volume) {
  return validate(volume.grid, volume.values.size());
}

/// Grid, number of values, and the transform and places of slices, which are finite. Errors: bad_argument.
Result<void> validate(const ScannedVolume& volume);

/// That the log can be one of this mesh, which is valid: it names vertices, wedges and triangles that are there.
/// O(log). Errors: bad_argument.
Result<void> validate(const CollapseLog& log, const Mesh& mesh, const Task& task = {});

}  // namespace lodestone
