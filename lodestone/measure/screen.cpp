#include "lodestone/measure/screen.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lodestone::measure {

namespace {
double tan_half_fov(const View& view) { return std::tan(view.fov_degrees * std::numbers::pi / 360.0); }
}  // namespace

double error_to_pixels(double error, double distance, const View& view) {
  return error * view.height_px / (2 * distance * tan_half_fov(view));
}

double pixels_to_error(double pixels, double distance, const View& view) {
  return pixels * 2 * distance * tan_half_fov(view) / view.height_px;
}

double switch_distance(double error, double pixels, const View& view) {
  return error * view.height_px / (2 * pixels * tan_half_fov(view));
}

double screen_coverage(double radius, double distance, const View& view) {
  const double center = distance + radius;
  if (!(center > 0)) return 1;
  const double projected = radius / (center * tan_half_fov(view));  // radius in half screen heights
  return std::min(1.0, std::numbers::pi * projected * projected / (4 * view.aspect));
}

}  // namespace lodestone::measure
