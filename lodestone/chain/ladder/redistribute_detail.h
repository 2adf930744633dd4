// One round of redistributing: more triangles where a level is worst, fewer where that costs least.
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

/// A tracked level whose vertices have names, see NamedMesh.
struct NamedLevel {
  simplify::TrackedLevel level;
  std::vector<std::uint32_t> names;  ///< one a vertex of its mesh
};

/// Names of the vertices that a collapse has left, where those before it had `names`.
std::vector<std::uint32_t> names_after(const std::vector<std::uint32_t>& names,
                                       const std::vector<std::uint32_t>& vertex_origin);

/// For each vertex, its entry in a list about the original's vertices; 0 for new ones, and where the list is empty.
std::vector<std::uint8_t> of_original(const std::vector<std::uint32_t>& names, const std::vector<std::uint8_t>& list);

/// A vertex that is no_move or no_collapse for as long as it lies at this position; once it has moved it is free again.
struct HeldVertex {
  std::uint32_t name = 0;
  Vec3f position;
};

/// Non-zero for the vertices of a list, which is sorted by name, that lie where they lay.
std::vector<std::uint8_t> still_held(const Mesh& mesh, const std::vector<std::uint32_t>& names,
                                     const std::vector<HeldVertex>& list);

struct RedistributeOptions {
  std::size_t most_triangles = 0;
  bool keeps_borders = true;            ///< vertices of open borders are the last to go
  bool fits = true;                     ///< split where the level is worst and fit what is new; else collapse alone
  std::vector<HeldVertex> no_collapse;  ///< vertices that are the last to collapse, by name
  std::vector<HeldVertex> no_move;      ///< the same, and they do not move, nor are triangles around them split
};

/// Splits triangles where the level is worst, collapses edges down to the count, those farthest from the original last,
/// and fits what is new. New vertices are named from `next_name` on. Errors: those of collapse_edges(), cancelled.
Result<NamedLevel> redistribute_triangles(const FeedbackSource& source, const NamedLevel& level,
                                          const RedistributeOptions& options, std::uint32_t& next_name,
                                          const Task& task);

}  // namespace lodestone::chain::detail
