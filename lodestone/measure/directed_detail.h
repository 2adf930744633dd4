// One direction of a surface distance: from samples and vertices of one surface to another.
#pragma once

#include <algorithm>
#include <cstdint>

#include "lodestone/base/task.h"
#include "lodestone/measure/distance.h"
#include "lodestone/spatial/bvh.h"

namespace lodestone::measure::detail {

constexpr double kBoundFloor = 1e-6;  // of the larger diagonal: what a bound may lie above a maximum near zero

/// How high the bound of a maximum may be.
inline double bound_goal(double max, double diagonal, const DistanceOptions& options) {
  return std::max(max * (1 + options.tolerance), max + kBoundFloor * diagonal);
}

/// `from` has its own order; `to` answers. Same figures for any thread count.
DirectedDistance directed_distance(const spatial::Surface& from, const spatial::Bvh& to, const DistanceOptions& options,
                                   const Task& task);

}  // namespace lodestone::measure::detail
