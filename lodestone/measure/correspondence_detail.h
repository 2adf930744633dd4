// Pairs of points, one on each surface, at which attributes are compared.
#pragma once

#include <cstdint>
#include <vector>

#include "lodestone/base/task.h"
#include "lodestone/spatial/bvh.h"
#include "lodestone/spatial/drawn_attributes.h"

namespace lodestone::measure::detail {

using spatial::SurfacePoint;

struct Pair {
  SurfacePoint from, to;
};

/// One pair a sample of `from` (see Sampler), in the samples' order; none for a surface without area. The rule by which
/// its partner is found stands in attributes.h. O((samples + triangles) log triangles), 48 bytes a sample.
std::vector<Pair> corresponding_points(const spatial::Surface& from, const spatial::Bvh& to, std::uint64_t samples,
                                       std::uint64_t seed, const Task& task);

}  // namespace lodestone::measure::detail
