#include "lodestone/math/triangle.h"
#include "lodestone/measure/sampling_detail.h"

namespace lodestone::measure::detail {

Sampler::Sampler(const spatial::Surface& surface, std::uint64_t count, std::uint64_t seed)
    : surface_(surface), count_(count), seed_(seed), areas_(surface.triangles.size() + 1, 0) {
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto [a, b, c] = surface.corners(t);
    areas_[t + 1] = areas_[t] + length(scaled_normal(a, b, c)) / 2;
  }
  if (!(areas_.back() > 0)) count_ = 0;
}

}  // namespace lodestone::measure::detail
