#include "lodestone/render/tone_detail.h"

#include "lodestone/core/srgb.h"

namespace lodestone::render::detail {

Tone::Tone() {
  for (std::size_t i = 0; i < light_.size(); ++i)
    light_[i] = static_cast<float>(light_of_srgb(static_cast<double>(i) / 255));
  std::size_t byte = 0;
  for (std::size_t step = 0; step < byte_.size(); ++step) {
    const double light = static_cast<double>(step) / kSteps;
    while (byte < 255 && light >= light_of_srgb((static_cast<double>(byte) + 0.5) / 255)) ++byte;
    byte_[step] = static_cast<std::uint8_t>(byte);
  }
}

const Tone& Tone::get() {
  static const Tone tone;
  return tone;
}

}  // namespace lodestone::render::detail
