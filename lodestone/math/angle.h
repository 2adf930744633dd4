// Sines and cosines of angles in degrees and back, the same bits on every machine.
#pragma once

#include <cmath>
#include <initializer_list>

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

/// The angle in [0, 180] degrees that has this cosine (cut to [-1, 1]), within 2e-6 degrees: exact at 1 and -1.
/// Abramowitz and Stegun, Handbook of Mathematical Functions, 4.4.46.
inline double arc_cosine_degrees(double cosine) {
  constexpr double kDegrees = 180 / 3.14159265358979323846;
  const double x = std::fabs(cosine);
  if (!(x < 1)) return cosine > 0 ? 0 : 180;
  double sum = -0.0012624911;
  for (const double c :
       {0.0066700901, -0.0170881256, 0.0308918810, -0.0501743046, 0.0889789874, -0.2145988016, 1.5707963050}) {
    sum = sum * x + c;
  }
  const double degrees = std::sqrt(1 - x) * sum * kDegrees;
  return cosine < 0 ? 180 - degrees : degrees;
}

/// The angle of (x, y) in radians, in [-pi, pi], within 4e-8; 0 at the origin. Abramowitz and Stegun, 4.4.49.
inline double arc_tangent(double y, double x) {
  constexpr double kPi = 3.14159265358979323846;
  const double ax = std::fabs(x), ay = std::fabs(y);
  const double small = ax < ay ? ax : ay, large = ax < ay ? ay : ax;
  if (!(large > 0)) return 0;
  const double t = small / large, tt = t * t;
  double sum = 0.0028662257;
  for (const double c :
       {-0.0161657367, 0.0429096138, -0.0752896400, 0.1065626393, -0.1420889944, 0.1999355085, -0.3333314528, 1.0}) {
    sum = sum * tt + c;
  }
  double angle = sum * t;
  if (ay > ax) angle = kPi / 2 - angle;
  if (x < 0) angle = kPi - angle;
  return y < 0 ? -angle : angle;
}

}  // namespace lodestone
