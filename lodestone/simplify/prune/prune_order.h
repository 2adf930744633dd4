// Thin parts: meshes of many small pieces (leaves, struts, crumbs), which edge collapse alone never makes fewer.
#pragma once

#include <cstdint>
#include <vector>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/input.h"
#include "lodestone/core/mesh.h"
#include "lodestone/core/parts.h"
#include "lodestone/math/mat.h"

namespace lodestone::simplify {

struct PruneOptions {
  bool keep_area = false;               ///< errors include how far the part that takes over grows
  std::vector<std::uint8_t> no_move;    ///< one a vertex, non-zero = its part stays as it is; empty = none
  std::vector<float> weights;           ///< one a vertex, 0 or more; empty = 1. A part's errors count as many times as
                                        ///< the root of its largest weight says, but never less than once
  std::vector<std::uint32_t> left_out;  ///< triangles that take no part (CollapseLog::dropped), ascending
  Mat4d metric;                         ///< mesh space to where errors are judged; see EdgeCollapseOptions
  Input input = Input::unchecked;       ///< of the mesh
};

/// A part vanishes; `absorber` takes over its area.
struct PruneStep {
  std::uint32_t part = 0, absorber = 0;
  float error = 0;  ///< estimated, units of the metric, never falling along the list
};

struct PruneOrder {
  Parts parts;
  std::vector<double> area;            ///< of each part, units of the metric squared
  std::vector<std::uint8_t> no_prune;  ///< one a part: holds a locked vertex
  std::vector<PruneStep> steps;        ///< all parts but the last and those that stay, the cheapest first
};

/// The order in which the parts of a mesh may vanish, greedily the one that errs least. A part's error is how far its
/// vertices are from the parts that remain, plus the error of what it stands for: parts that took over others inherit
/// theirs. One part always remains. Time O(n log n) for parts of bounded size, memory about 150 bytes a triangle.
/// The same for any number of threads. Errors: bad_argument (sizes of `no_move` or `weights`, a triangle
/// `left_out` that is not there; those of validate()), cancelled.
Result<PruneOrder> prune_order(const Mesh& mesh, const PruneOptions& options = {}, Task task = {});

}  // namespace lodestone::simplify
