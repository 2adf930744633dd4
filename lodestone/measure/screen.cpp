#include "lodestone/measure/screen.h"

#include <algorithm>
#include <limits>
#include <numbers>

#include "lodestone/math/angle.h"

namespace lodestone::measure {

namespace {

// Half of what the screen shows in height at `distance`, model units.
double half_height(double distance, const View& view) {
  if (view.orthographic_height > 0) return view.orthographic_height / 2;
  return distance * sin_cos_degrees(view.fov_degrees / 2).tan();
}

}  // namespace

double error_to_pixels(double error, double distance, const View& view) {
  return error * view.height_px / (2 * half_height(distance, view));
}

double pixels_to_error(double pixels, double distance, const View& view) {
  return pixels * 2 * half_height(distance, view) / view.height_px;
}

double switch_distance(double error, double pixels, const View& view) {
  if (view.orthographic_height > 0) {
    return error <= pixels_to_error(pixels, 1, view) ? 0 : std::numeric_limits<double>::infinity();
  }
  return error / pixels_to_error(pixels, 1, view);
}

double screen_coverage(double radius, double distance, const View& view) {
  const double center = distance + radius;
  if (!(center > 0)) return 1;
  const double projected = radius / half_height(center, view);  // radius in half screen heights
  return std::min(1.0, std::numbers::pi * projected * projected / (4 * view.aspect));
}

}  // namespace lodestone::measure
