#include <algorithm>
#include <cmath>
#include <limits>

#include "lodestone/chain/ladder/error_curve_detail.h"

namespace lodestone::chain::detail {

bool tells(const CurvePoint& point, double diagonal) {
  return point.triangles > 0 && point.error >= kLeastTelling * diagonal;
}

double most_in_line(const std::vector<CurvePoint>& finer, std::size_t triangles, double diagonal, bool of_parts) {
  constexpr double kMost = 2, kSphere = 4, kPart = 4, kNoRuin = 1e-3;
  const CurvePoint *last = nullptr, *before = nullptr;
  for (const CurvePoint& point : finer) {
    if (!tells(point, diagonal)) continue;
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
  const double few = (of_parts ? kPart : 1) * kSphere * diagonal / n;
  return std::max(kMost * std::max(expected, few), kNoRuin * diagonal);
}

}  // namespace lodestone::chain::detail
