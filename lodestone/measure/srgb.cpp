#include <algorithm>
#include <cmath>

#include "lodestone/measure/srgb_detail.h"

namespace lodestone::measure::detail {

Vec3d to_srgb(Vec3d light) {
  Vec3d out;
  for (std::size_t k = 0; k < 3; ++k) {
    const double c = std::clamp(light[k], 0.0, 1.0);
    out[k] = c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
  }
  return out;
}

}  // namespace lodestone::measure::detail
