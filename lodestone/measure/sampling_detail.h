// Area-weighted, stratified points on a surface: the same ones for every figure that is taken of it.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "lodestone/base/random.h"
#include "lodestone/spatial/surface.h"

namespace lodestone::measure::detail {

struct Sample {
  std::uint32_t triangle = 0;
  Vec3d point;
  std::array<double, 3> weights{};  ///< of the triangle's corners
};

/// The i-th of `count` samples lies in the i-th of `count` equal shares of the area, at random within its triangle.
/// Everything about it depends on the surface, `count`, `seed` and i. The surface must outlive the sampler.
class Sampler {
 public:
  Sampler(const spatial::Surface& surface, std::uint64_t count, std::uint64_t seed);

  /// 0 for a surface without area.
  std::uint64_t count() const { return count_; }

  /// Calls take(i, sample) for begin..end in order.
  template <class Take>
  void for_each(std::size_t begin, std::size_t end, Take&& take) const {
    std::size_t t = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const double place =
          (static_cast<double>(i) + random_unit(seed_, 3 * i)) / static_cast<double>(count_) * areas_.back();
      if (i == begin)
        t = static_cast<std::size_t>(std::upper_bound(areas_.begin(), areas_.end(), place) - areas_.begin()) - 1;
      while (t + 2 < areas_.size() && areas_[t + 1] <= place) ++t;
      t = std::min(t, surface_.triangles.size() - 1);
      const auto [a, b, c] = surface_.corners(t);
      const double r = std::sqrt(random_unit(seed_, 3 * i + 1)), s = random_unit(seed_, 3 * i + 2);
      const std::array<double, 3> w{1 - r, r * (1 - s), r * s};
      take(i, Sample{static_cast<std::uint32_t>(t), a * w[0] + b * w[1] + c * w[2], w});
    }
  }

 private:
  const spatial::Surface& surface_;
  std::uint64_t count_, seed_;
  std::vector<double> areas_;  // running sum: triangle t covers [areas_[t], areas_[t + 1])
};

}  // namespace lodestone::measure::detail
