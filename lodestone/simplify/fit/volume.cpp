#include "lodestone/simplify/fit/volume_detail.h"

#include <algorithm>
#include <array>

#include "lodestone/math/triangle.h"
#include "lodestone/spatial/neighbors.h"

namespace lodestone::simplify::detail {

namespace {

bool is_closed(const spatial::Surface& surface) {
  const std::vector<std::array<std::uint32_t, 3>> neighbors = spatial::triangle_neighbors(surface);
  return std::none_of(neighbors.begin(), neighbors.end(), [](const auto& around) {
    return std::find(around.begin(), around.end(), kNone) != around.end();
  });
}

// Signed, seen from the middle of `around`.
double volume_of(const spatial::Surface& surface, Vec3d middle) {
  double sum = 0;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto [a, b, c] = surface.corners(t);
    sum += dot(a - middle, cross(b - middle, c - middle));
  }
  return sum / 6;
}

}  // namespace

std::vector<Vec3d> volume_moves(const spatial::Surface& original, const spatial::Surface& level,
                                std::span<const std::uint8_t> no_move) {
  if (!is_closed(original) || !is_closed(level)) return {};
  const Vec3d middle = (original.bounds.min + original.bounds.max) / 2.0;
  const double missing = volume_of(original, middle) - volume_of(level, middle);
  std::vector<Vec3d> gradient(level.positions.size());  // of the volume
  for (std::size_t t = 0; t < level.triangles.size(); ++t) {
    const auto [a, b, c] = level.corners(t);
    for (const std::uint32_t v : level.triangles[t]) {
      if (no_move[v] == 0) gradient[v] += scaled_normal(a, b, c) / 6.0;
    }
  }
  double sum = 0;
  for (const Vec3d& g : gradient) sum += length(g);
  if (!(sum > 0)) return {};
  for (Vec3d& g : gradient) g = normalized(g) * (missing / sum);
  return gradient;
}

}  // namespace lodestone::simplify::detail
