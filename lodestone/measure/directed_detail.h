// One direction of a surface distance: from samples and vertices of one surface to another.
#pragma once

#include <cstdint>

#include "lodestone/base/task.h"
#include "lodestone/measure/distance.h"
#include "lodestone/spatial/bvh.h"

namespace lodestone::measure::detail {

/// `from` has its own order; `to` answers. Same figures for any thread count.
DirectedDistance directed_distance(const spatial::Surface& from, const spatial::Bvh& to, const DistanceOptions& options,
                                   const Task& task);

}  // namespace lodestone::measure::detail
