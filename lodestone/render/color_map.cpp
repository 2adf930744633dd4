#include "lodestone/render/color_map.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "lodestone/render/tone_detail.h"

namespace lodestone::render {

Vec3f heat_color(float share) {
  constexpr std::uint8_t kColors[10][3] = {{68, 1, 84},    {72, 40, 120},  {62, 74, 137},  {49, 104, 142},
                                           {38, 130, 142}, {31, 158, 137}, {53, 183, 121}, {109, 205, 89},
                                           {180, 222, 44}, {253, 231, 37}};
  const float at = share > 0 ? std::min(share, 1.0F) * 9 : 0.0F;
  const auto i = std::min<std::size_t>(static_cast<std::size_t>(at), 8);
  const float t = at - static_cast<float>(i);
  Vec3f out;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto a = static_cast<float>(kColors[i][k]), b = static_cast<float>(kColors[i + 1][k]);
    out[k] = (a + (b - a) * t) * (1.0F / 255);
  }
  return out;
}

Vec3f heat_light(float share) { return detail::light_of(heat_color(share)); }

}  // namespace lodestone::render
