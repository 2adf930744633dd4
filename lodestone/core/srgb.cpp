#include "lodestone/core/srgb.h"

#include <algorithm>
#include <array>

namespace lodestone {

namespace {

// Newton's method from above: pow() differs in its last bits between machines, this doesn't.
double fifth_root(double a) {
  double y = 1;
  for (int i = 0; i < 60; ++i) y = (4 * y + a / (y * y * y * y)) / 5;
  return y;
}

// The light of each byte, and the light from which on a byte is the nearest one.
struct Tables {
  std::array<double, 256> light;
  std::array<double, 256> from;

  Tables() {
    for (std::size_t i = 0; i < 256; ++i) {
      light[i] = light_of_srgb(static_cast<double>(i) / 255);
      from[i] = i == 0 ? 0 : light_of_srgb((static_cast<double>(i) - 0.5) / 255);
    }
  }
};

const Tables& tables() {
  static const Tables made;
  return made;
}

}  // namespace

double light_of_srgb(double srgb) {
  if (srgb <= 0.04045) return srgb / 12.92;
  const double t = (srgb + 0.055) / 1.055;
  return t * t * fifth_root(t * t);  // t^2.4
}

double light_of_byte(std::uint8_t byte) { return tables().light[byte]; }

std::uint8_t byte_of_light(double light) {
  if (!(light > 0)) return 0;
  const std::array<double, 256>& from = tables().from;
  return static_cast<std::uint8_t>(std::upper_bound(from.begin(), from.end(), light) - from.begin() - 1);
}

}  // namespace lodestone
