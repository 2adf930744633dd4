// The tree in which the blunt corners of a polygon are looked up.
#include <algorithm>
#include <array>
#include <bit>
#include <limits>

#include "lodestone/io/plain/polygon_ears_detail.h"

namespace lodestone::io {

namespace {

constexpr std::size_t kLeaf = 8;  // corners in a leaf, but for the last one

// False where all of the box lies to the right of the line from a to b, as `sign` turns it.
bool reaches_left(Vec2d low, Vec2d high, Vec2d a, Vec2d b, double sign) {
  const double nx = sign * (a.y - b.y), ny = sign * (b.x - a.x);
  const double x = nx > 0 ? high.x : low.x, y = ny > 0 ? high.y : low.y;
  return nx * (x - a.x) + ny * (y - a.y) >= 0;
}

}  // namespace

void BluntCorners::build(std::span<const Vec2d> points, std::span<const std::uint8_t> marked) {
  const std::size_t n = points.size();
  order_.resize(n);
  for (std::size_t i = 0; i < n; ++i) order_[i] = static_cast<std::uint32_t>(i);
  std::size_t height = 0;
  while ((kLeaf << height) < n) ++height;
  first_leaf_ = (std::size_t{1} << height) - 1;
  boxes_.resize(2 * first_leaf_ + 1);
  live_.assign(boxes_.size(), 0);
  points_.assign(points.begin(), points.end());
  fill(0, 0, n, height);
  place_.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    points_[i] = points[order_[i]];
    place_[order_[i]] = static_cast<std::uint32_t>(i);
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (marked[i] != 0) change(static_cast<std::uint32_t>(i), 1);
  }
}

// Left children are full, so that a place tells its leaf. While it sorts, points_ are in the polygon's order.
void BluntCorners::fill(std::size_t node, std::size_t begin, std::size_t end, std::size_t height) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Box box{{kFar, kFar}, {-kFar, -kFar}};
  for (std::size_t i = begin; i < end; ++i) {
    const Vec2d p = points_[order_[i]];
    box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y)};
    box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y)};
  }
  boxes_[node] = box;
  if (height == 0) return;
  const std::size_t middle = std::min(begin + (kLeaf << (height - 1)), end);
  if (middle < end) {
    const bool by_x = box.high.x - box.low.x > box.high.y - box.low.y;
    const auto at = [&](std::size_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t a, std::uint32_t b) {
      const double pa = by_x ? points_[a].x : points_[a].y, pb = by_x ? points_[b].x : points_[b].y;
      return pa != pb ? pa < pb : a < b;
    });
  }
  fill(2 * node + 1, begin, middle, height - 1);
  fill(2 * node + 2, middle, end, height - 1);
}

void BluntCorners::change(std::uint32_t corner, int by) {
  const std::size_t place = place_[corner];
  std::size_t node = first_leaf_ + place / kLeaf;
  live_[node] ^= 1U << (place % kLeaf);
  while (node > 0) {
    node = (node - 1) / 2;
    live_[node] += static_cast<std::uint32_t>(by);
  }
}

bool BluntCorners::leaf_has_inside(std::size_t leaf, Vec2d a, Vec2d b, Vec2d c, double sign) const {
  for (std::uint32_t left = live_[first_leaf_ + leaf]; left != 0; left &= left - 1) {
    const Vec2d p = points_[leaf * kLeaf + static_cast<std::size_t>(std::countr_zero(left))];
    // Corners at the place of one of the triangle's are let in: polygons with bridges to their holes have such.
    if (p == a || p == b || p == c) continue;
    if (sign * cross2(a, b, p) >= 0 && sign * cross2(b, c, p) >= 0 && sign * cross2(c, a, p) >= 0) return true;
  }
  return false;
}

bool BluntCorners::any_inside(Vec2d a, Vec2d b, Vec2d c, double sign, std::uint64_t& budget) const {
  const Vec2d low{std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y})};
  const Vec2d high{std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y})};
  std::array<std::size_t, 64> open{};
  std::size_t waiting = 1;  // the root
  while (waiting > 0) {
    const std::size_t node = open[--waiting];
    budget -= budget > 0 ? 1 : 0;
    const Box& box = boxes_[node];
    if (live_[node] == 0 || box.low.x > high.x || box.high.x < low.x || box.low.y > high.y || box.high.y < low.y ||
        !reaches_left(box.low, box.high, a, b, sign) || !reaches_left(box.low, box.high, b, c, sign) ||
        !reaches_left(box.low, box.high, c, a, sign)) {
      continue;
    }
    if (node < first_leaf_) {
      open[waiting++] = 2 * node + 2;
      open[waiting++] = 2 * node + 1;
    } else if (leaf_has_inside(node - first_leaf_, a, b, c, sign)) {
      return true;
    }
  }
  return false;
}

}  // namespace lodestone::io
