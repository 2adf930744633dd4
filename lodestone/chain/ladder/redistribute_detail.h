// One round of redistributing: triangles where a level is worst, in place of those that are missed least.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/chain/ladder/feedback_detail.h"
#include "lodestone/simplify/fit/tracked_level.h"

namespace lodestone::chain::detail {

/// Raises the weights of vertices on open borders, so that they go no sooner than without weights elsewhere.
void weight_borders(const Mesh& mesh, float weight, std::vector<float>& weights, const Task& task);

/// Non-zero for vertices at one of these positions, which are sorted as before() does.
std::vector<std::uint8_t> at_positions(const Mesh& mesh, const std::vector<Vec3f>& positions);

struct RedistributeOptions {
  std::size_t most_triangles = 0;
  bool keeps_borders = true;       ///< vertices of open borders are the last to go
  bool fits = true;                ///< split where the level is worst and fit what is new; else collapse alone
  std::vector<Vec3f> no_collapse;  ///< positions of vertices not to collapse, sorted as before() does,
  std::vector<Vec3f> no_move;      ///< and of some not to move, nor to split the triangles of, either
};

/// Splits triangles where the level is worst, collapses others down to the count, those that are farthest from the
/// original last, and fits what is new. Errors: those of collapse_edges(), cancelled.
Result<simplify::TrackedLevel> redistribute_triangles(const FeedbackSource& source, const simplify::TrackedLevel& level,
                                                      const RedistributeOptions& options, const Task& task);

}  // namespace lodestone::chain::detail
