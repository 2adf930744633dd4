// Winding numbers: how often a surface, closed or not, goes around a point.
//
// Source: A. Jacobson et al., 2013 [jacobson-2013]: the sum of the solid angles of all triangles, over 4 pi; for groups
// that are far away only a dipole, G. Barill et al., 2018 [barill-2018], first order.
// 1. AngleSum: solid angles (A. Van Oosterom and J. Strackee, 1983 [van-oosterom-1983]) added up as arguments of
//    complex numbers, so that many of them need one arc tangent.
// 2. in_order(), group_of(): triangles by size and along a Hilbert curve; groups of four, of sixteen, and so on.
// 3. WindingNumber::at(): down the groups; a group is far when its centre is more than twice its radius away.
// Invariants: no libm but sqrt; the same figures for any thread count. Cost: O(n log n) to build.
#include "lodestone/voxel/winding.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "lodestone/base/parallel.h"
#include "lodestone/math/angle.h"
#include "lodestone/math/box.h"
#include "lodestone/spatial/hilbert.h"

namespace lodestone::voxel {

namespace {

constexpr std::size_t kFan = 4;   // groups of one above
constexpr double kFarSq = 2 * 2;  // of the distance over the radius
constexpr double kPi = 3.14159265358979323846;

// A sum of angles as the product of complex numbers with these arguments, and whole turns: one arc tangent for many
// angles, whose series would take most of the time.
struct AngleSum {
  double re = 1, im = 0;
  int turns = 0;

  // The half of a triangle's solid angle as seen from the origin (A. Van Oosterom and J. Strackee, 1983), which is in
  // [-pi, pi].
  void add(Vec3d a, Vec3d b, Vec3d c) {
    const double la = length(a), lb = length(b), lc = length(c), product = la * lb * lc;
    if (!(product > 0)) return;
    const double inverse = 1 / product;  // keeps numbers within [-4, 4] each
    const double y = dot(a, cross(b, c)) * inverse;
    const double x = 1 + (dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb) * inverse;
    const double new_re = re * x - im * y, new_im = re * y + im * x;
    if (im >= 0 && y >= 0 && new_im < 0) ++turns;
    if (im < 0 && y < 0 && new_im >= 0) --turns;
    // Powers of two: no bit is lost.
    const double size = std::abs(new_re) + std::abs(new_im);
    const double scale = size > 0x1p300 ? 0x1p-300 : size < 0x1p-300 ? 0x1p300 : 1;
    re = new_re * scale;
    im = new_im * scale;
  }
  double value() const { return arc_tangent(im, re) + turns * 2 * kPi; }
};

// By size, in steps of four, then along a Hilbert curve: a large triangle among small ones would make their group's
// radius large, and so a query slow.
std::vector<Triangle> in_order(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles,
                               const Task& task) {
  Box3d box;
  for (const Triangle& t : triangles) {
    for (const std::uint32_t v : t) box.add(positions[v]);
  }
  const Vec3d size = box.size();
  const double longest = std::max({size.x, size.y, size.z});
  struct Key {
    std::uint64_t place;  // the size in the highest bits
    std::uint32_t triangle;
  };
  std::vector<Key> keys(triangles.size());
  parallel_for(keys.size(), 4096, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t t = begin; t < end; ++t) {
      Box3d own;
      for (const std::uint32_t v : triangles[t]) own.add(positions[v]);
      const Vec3d sides = own.size();
      const double side = std::max({sides.x, sides.y, sides.z});
      std::uint64_t halvings = 0;
      for (double s = longest; s > side && halvings < 30; s /= 2) ++halvings;
      const auto cell = [&](std::size_t k) {
        return longest > 0 ? static_cast<std::uint32_t>((own.center()[k] - box.min[k]) / longest * 65535) : 0U;
      };
      keys[t] = {halvings / 2 << 48 | spatial::hilbert_key(cell(0), cell(1), cell(2)), static_cast<std::uint32_t>(t)};
    }
  });
  parallel_sort(keys, task, [](const Key& a, const Key& b) { return a.place < b.place; });
  std::vector<Triangle> ordered;
  for (const Key& key : keys) ordered.push_back(triangles[key.triangle]);
  return ordered;
}

}  // namespace

std::array<Vec3d, 3> WindingNumber::corners(std::size_t triangle) const {
  const Triangle& t = triangles_[triangle];
  return {positions_[t[0]], positions_[t[1]], positions_[t[2]]};
}

WindingNumber::Group WindingNumber::group_of(std::size_t first, std::size_t last) const {
  Group g;
  for (std::size_t t = first; t < last; ++t) {
    const auto [a, b, c] = corners(t);
    const Vec3d n = cross(b - a, c - a) * 0.5;
    const double area = length(n);
    g.area_normal += n;
    g.area += area;
    g.center += (a + b + c) * (area / 3);
  }
  g.center = g.area > 0 ? g.center / g.area : corners(first)[0];
  for (std::size_t t = first; t < last; ++t) {
    for (const Vec3d& p : corners(t)) g.radius_sq = std::max(g.radius_sq, length_sq(p - g.center));
  }
  return g;
}

WindingNumber::WindingNumber(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles,
                             const Task& task)
    : positions_(positions), triangles_(in_order(positions, triangles, task)) {
  for (std::size_t size = 1; !triangles_.empty(); size *= kFan) {
    const std::size_t first = groups_.size(), count = (triangles_.size() + size - 1) / size;
    level_first_.push_back(first);
    groups_.resize(first + count);
    parallel_for(count, 256, task, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t i = begin; i < end; ++i) {
        groups_[first + i] = group_of(i * size, std::min((i + 1) * size, triangles_.size()));
      }
    });
    if (count == 1) break;
  }
}

double WindingNumber::at(Vec3d point) const {
  if (triangles_.empty()) return 0;
  struct StackEntry {
    std::size_t level, group;  // of the level
  };
  std::array<StackEntry, 17 * kFan> stack;
  std::size_t top = 0;
  stack[top++] = {level_first_.size() - 1, 0};
  double far = 0;
  AngleSum near;
  while (top > 0) {
    const StackEntry place = stack[--top];
    const Group& g = groups_[level_first_[place.level] + place.group];
    const Vec3d to = g.center - point;
    const double distance_sq = dot(to, to);
    if (distance_sq > kFarSq * g.radius_sq) {
      far += dot(g.area_normal, to) / (distance_sq * std::sqrt(distance_sq));
    } else if (place.level == 0) {
      const auto [a, b, c] = corners(place.group);
      near.add(a - point, b - point, c - point);
    } else {
      const std::size_t first = place.group * kFan;
      const std::size_t below = level_first_[place.level] - level_first_[place.level - 1];
      for (std::size_t k = std::min(first + kFan, below); k-- > first;) stack[top++] = {place.level - 1, k};
    }
  }
  return (far + 2 * near.value()) / (4 * kPi);
}

}  // namespace lodestone::voxel
