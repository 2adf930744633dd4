#include "lodestone/render/tone_detail.h"

namespace lodestone::render::detail {

namespace {

// Newton's method from above: pow() differs in its last bits between machines, this doesn't.
double fifth_root(double a) {
  double y = 1;
  for (int i = 0; i < 60; ++i) y = (4 * y + a / (y * y * y * y)) / 5;
  return y;
}

double light_of(double srgb) {
  if (srgb <= 0.04045) return srgb / 12.92;
  const double t = (srgb + 0.055) / 1.055;
  return t * t * fifth_root(t * t);  // t^2.4
}

}  // namespace

Tone::Tone() {
  for (std::size_t i = 0; i < light_.size(); ++i)
    light_[i] = static_cast<float>(light_of(static_cast<double>(i) / 255));
  std::size_t byte = 0;
  for (std::size_t step = 0; step < byte_.size(); ++step) {
    const double light = static_cast<double>(step) / kSteps;
    while (byte < 255 && light >= light_of((static_cast<double>(byte) + 0.5) / 255)) ++byte;
    byte_[step] = static_cast<std::uint8_t>(byte);
  }
}

const Tone& Tone::get() {
  static const Tone tone;
  return tone;
}

}  // namespace lodestone::render::detail
