// The meshes that are collapsed in place of the original's: with near vertices welded and near parts joined.
#pragma once

#include <vector>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/chain/ladder/constraints.h"
#include "lodestone/core/model.h"

namespace lodestone::chain::detail {

/// The placing of each mesh that shows its errors largest. The mesh is simplified in that space, so that its errors are
/// the scene's.
std::vector<Mat4d> largest_placings(const Model& model);

/// Empty when `constraints` neither welds nor joins; triangles keep their numbers. Vertices of triangles that must not
/// change (`untouched`, as untouched_triangles() gives them) do not move. Errors: cancelled, bad_argument.
Result<std::vector<Mesh>> working_meshes(const Model& model, const std::vector<Mat4d>& placings,
                                         const SimplifyConstraints& constraints,
                                         const std::vector<std::vector<std::uint8_t>>& untouched, const Task& task);

}  // namespace lodestone::chain::detail
