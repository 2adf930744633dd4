#include <algorithm>
#include <cmath>
#include <limits>

#include "lodestone/chain/error_curve_detail.h"

namespace lodestone::chain::detail {

double most_in_line(const std::vector<CurvePoint>& finer, std::size_t triangles, double diagonal, bool of_parts) {
  constexpr double kMost = 2, kSphere = 4, kPart = 4;
  const CurvePoint *last = nullptr, *before = nullptr;
  for (const CurvePoint& point : finer) {
    if (!(point.error > 0) || point.triangles == 0) continue;
    before = last;
    last = &point;
  }
  if (last == nullptr) return std::numeric_limits<double>::infinity();
  const auto n = static_cast<double>(std::max<std::size_t>(1, triangles));
  const auto shrinks = [](double from, double to) { return std::max(1.0, from / to); };
  bool is_steep = false;  // grows faster than n^-1.25: nearer to n^-1.5 than to 1 / n
  if (before != nullptr) {
    const double step = shrinks(static_cast<double>(before->triangles), static_cast<double>(last->triangles));
    is_steep = last->error >= before->error * step * std::sqrt(std::sqrt(step));
  }
  const double step = shrinks(static_cast<double>(last->triangles), n);
  const double expected = last->error * (is_steep ? step * std::sqrt(step) : step);
  return kMost * std::max(expected, (of_parts ? kPart : 1) * kSphere * diagonal / n);
}

}  // namespace lodestone::chain::detail
