// One direction of a surface distance: from samples and vertices of one surface to another.
#pragma once

#include <algorithm>
#include <cstdint>

#include "lodestone/base/task.h"
#include "lodestone/measure/distance.h"
#include "lodestone/spatial/bvh.h"

namespace lodestone::measure::detail {

/// How far a bound may lie above any maximum.
inline double least_tolerance(double diagonal, const DistanceOptions& options) {
  return options.least_tolerance > 0 ? options.least_tolerance : 1e-6 * diagonal;
}

/// How high the bound of a maximum may be.
inline double bound_goal(double max, double diagonal, const DistanceOptions& options) {
  return std::max(max * (1 + options.tolerance), max + least_tolerance(diagonal, options));
}

/// `from` has its own order; `to` answers. Same figures for any thread count.
DirectedDistance directed_distance(const spatial::Surface& from, const spatial::Bvh& to, const DistanceOptions& options,
                                   const Task& task);

}  // namespace lodestone::measure::detail
