// Sine and cosine of angles in degrees, the same bits on every machine.
#pragma once

#include <cmath>

namespace lodestone {

struct SinCos {
  double sin = 0, cos = 1;
  double tan() const { return sin / cos; }
};

/// Within 2e-16 of the true values, exact at multiples of 90 degrees. Taylor's series on 45 degrees to either side of
/// the nearest quarter turn, instead of libm whose last bits differ between machines.
inline SinCos sin_cos_degrees(double degrees) {
  constexpr double kRadians = 3.14159265358979323846 / 180;
  double turn = std::fmod(degrees, 360.0);  // exact by definition
  if (turn < 0) turn += 360;
  const int quarter = static_cast<int>(turn / 90 + 0.5);
  const double x = (turn - quarter * 90) * kRadians, xx = x * x;
  double s = 1, c = 1;
  for (int n = 17; n >= 3; n -= 2) s = 1 - s * xx / (n * (n - 1));
  for (int n = 18; n >= 2; n -= 2) c = 1 - c * xx / (n * (n - 1));
  s *= x;
  switch (quarter % 4) {
    case 0:
      return {s, c};
    case 1:
      return {c, -s};
    case 2:
      return {-s, -c};
    default:
      return {-c, s};
  }
}

}  // namespace lodestone
