// Levels improved by their own measured error: weighted (effort normal) or fitted (effort best).
//
//   build_ladder(), simplify_model()
//     CollapsePlan::create()            collapse_edges() once a mesh, prune_order(), merged by error
//     LevelMaker::plain()               CollapsePlan::model_after(): a prefix replayed; then measured
//     LevelMaker::with_feedback()       the better of plain() and
//       CollapsePlan::model_with_feedback()
//         apply_feedback()              for each mesh that allows it
//           weighted()                  collapse_edges() again, weights from error_at_vertices()
//           fitted()                    weighted() where there are borders, then
//             TrackedLevel::fit()       vertices moved, edges turned
//             redistribute_rounds()     redistribute_triangles(): split_worst(), collapse_edges(), fit() of what is new
//             meet_volume()
//           fewest_within_goal()        with an error to hold: redistribute_triangles(), certified at each step
#pragma once

#include <cstdint>
#include <vector>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/chain/ladder/effort.h"
#include "lodestone/core/mesh.h"
#include "lodestone/measure/distance.h"
#include "lodestone/simplify/collapse/edge_collapse.h"
#include "lodestone/simplify/fit/target.h"

namespace lodestone::chain::detail {

/// What a level of one mesh is made from.
struct FeedbackSource {
  const Mesh& start;                             ///< what is collapsed: the original, or a finer level of it
  const simplify::FitTarget& target;             ///< the original
  std::vector<std::uint32_t> start_names;        ///< of the start's vertices: their numbers in the original
  const simplify::EdgeCollapseOptions& options;  ///< of the plain run, about the original; its target is not used
  /// A maximum that is enough, mesh units, for as few triangles as it takes; 0 = as small as it gets.
  double goal = 0;
  const measure::Reference* reference = nullptr;  ///< the original, mesh units; needed with a goal
};

/// A level whose vertices have names, by which they are known in other levels of the same original: their number there
/// if the original has them, above its count of vertices if they are new.
struct NamedMesh {
  Mesh mesh;
  std::vector<std::uint32_t> names;  ///< one a vertex
};

/// A mesh of at most as many triangles as `level`, which the plain run made, and nearer to the original as a rule:
/// whoever keeps it measures both. With normal effort `start` is collapsed again, vertices where the level is worst
/// weighing more; twice, the smallest maximum kept. With best, vertices are moved and edges turned to where distances
/// are least; then triangles are added where the level is worst and taken away where they are missed least, in rounds,
/// the smallest maximum kept. Errors: those of collapse_edges(), cancelled.
Result<Mesh> apply_feedback(const FeedbackSource& source, NamedMesh level, Effort effort, const Task& task);

}  // namespace lodestone::chain::detail
