// Pairs of points, one on each surface, at which attributes are compared.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "lodestone/base/task.h"
#include "lodestone/spatial/bvh.h"

namespace lodestone::measure::detail {

/// A point of a surface: a triangle and its corners' weights.
struct Place {
  std::uint32_t triangle = 0;
  double second = 0, third = 0;  ///< weights of the second and the third corner

  std::array<double, 3> weights() const { return {1 - second - third, second, third}; }
};

struct Pair {
  Place from, to;
};

/// One pair a sample of `from` (see Sampler), in the samples' order; none for a surface without area. The rule by which
/// its partner is found stands in attributes.h. O((samples + triangles) log triangles), 48 bytes a sample.
std::vector<Pair> corresponding_points(const spatial::Surface& from, const spatial::Bvh& to, std::uint64_t samples,
                                       std::uint64_t seed, const Task& task);

}  // namespace lodestone::measure::detail
