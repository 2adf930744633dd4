// Levels improved by their own measured error: weighted (effort normal) or fitted (effort best).
//
// build_ladder, simplify_model
//  +- CollapsePlan::create ................ collapse_edges once a mesh, prune_order; steps merged by error
//  +- find_error_cut, keep_in_line ........ searches; they call the two below
//  +- LevelMaker::plain ................... CollapsePlan::model_after (a prefix replayed), then measured
//  +- LevelMaker::with_feedback ........... the better of plain and:
//      +- CollapsePlan::model_with_feedback
//          +- apply_feedback .............. for each mesh that allows it
//              +- weighted ................ effort normal: raise_weights, collapse_edges, TrackedLevel; twice
//              +- fitted .................. effort best:
//              |   +- weighted ............ only where there are borders
//              |   +- fit_without_faults .. TrackedLevel::fit: vertices moved, edges turned
//              |   +- redistribute_rounds . redistribute_triangles; not with a goal or weights
//              |   +- meet_volume ......... TrackedLevel::fit: the volume alone; not with a goal
//              +- fewest_within_goal ...... with a goal:
//                  +- within_goal ......... redistribute_triangles, certified by holds_goal
// redistribute_triangles: split_worst, collapse_edges, TrackedLevel, TrackedLevel::fit of what is new
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
  /// A maximum not to exceed, mesh units, with as few triangles as possible; 0 = the smallest that can be found.
  double goal = 0;
  const measure::Reference* reference = nullptr;  ///< the original, mesh units; needed with a goal
};

/// A level whose vertices have names, by which they are known in other levels of the same original: the vertex's number
/// in the original, or, for a new vertex, a number above all of those.
struct NamedMesh {
  Mesh mesh;
  std::vector<std::uint32_t> names;  ///< one a vertex
};

/// A mesh of at most as many triangles as `level`, which the plain run made, and nearer to the original as a rule; the
/// caller measures both and takes the better. Weighted (effort normal): `start` is collapsed again, vertices where the
/// level is worst weighing more, in two rounds. Fitted (effort best): vertices are moved and edges turned to where
/// distances are least; then, in rounds, triangles are added where the level is worst and removed where that costs
/// least. Of all rounds the one with the smallest maximum counts. Errors: those of collapse_edges(), cancelled.
Result<Mesh> apply_feedback(const FeedbackSource& source, NamedMesh level, Effort effort, const Task& task);

}  // namespace lodestone::chain::detail
