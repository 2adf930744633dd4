#include "lodestone/voxel/winding.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "lodestone/base/parallel.h"
#include "lodestone/math/angle.h"

namespace lodestone::voxel {

namespace {

constexpr std::size_t kFan = 8;   // triangles of a group of level 0, groups of one above
constexpr double kFarSq = 2 * 2;  // of the distance over the radius
constexpr double kPi = 3.14159265358979323846;

// Half of the solid angle of a triangle (A. Van Oosterom and J. Strackee, 1983).
double half_solid_angle(Vec3d a, Vec3d b, Vec3d c) {
  const double la = length(a), lb = length(b), lc = length(c);
  const double volume = dot(a, cross(b, c));
  const double rest = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
  return arc_tangent(volume, rest);
}

}  // namespace

WindingNumber::WindingNumber(const spatial::Surface& surface, const Task& task) : surface_(surface) {
  std::size_t count = (surface.triangles.size() + kFan - 1) / kFan, total = 0;
  for (std::size_t n = count;; n = (n + kFan - 1) / kFan) {
    level_first_.push_back(total);
    total += n;
    if (n <= 1) break;
  }
  level_first_.push_back(total);
  groups_.resize(total);
  const auto finish = [](Group& g, auto&& for_each_point) {
    if (g.area > 0) g.center = g.center / g.area;
    for_each_point([&](Vec3d p, double slack) {
      const double r = length(p - g.center) + slack;
      g.radius_sq = std::max(g.radius_sq, r * r);
    });
  };
  parallel_for(count, 256, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      Group& g = groups_[i];
      const std::size_t first = i * kFan, last = std::min(first + kFan, surface_.triangles.size());
      for (std::size_t t = first; t < last; ++t) {
        const auto [a, b, c] = surface_.corners(t);
        const Vec3d n = cross(b - a, c - a) * 0.5;
        const double area = length(n);
        g.area_normal += n;
        g.area += area;
        g.center += (a + b + c) * (area / 3);
      }
      if (!(g.area > 0)) g.center = surface_.corners(first)[0];
      finish(g, [&](auto&& take) {
        for (std::size_t t = first; t < last; ++t) {
          for (const Vec3d& p : surface_.corners(t)) take(p, 0.0);
        }
      });
    }
  });
  for (std::size_t level = 1; level + 1 < level_first_.size(); ++level) {
    const std::size_t below = level_first_[level - 1], here = level_first_[level];
    for (std::size_t i = here; i < level_first_[level + 1]; ++i) {
      Group& g = groups_[i];
      const std::size_t first = below + (i - here) * kFan, last = std::min(first + kFan, here);
      for (std::size_t k = first; k < last; ++k) {
        g.area_normal += groups_[k].area_normal;
        g.area += groups_[k].area;
        g.center += groups_[k].center * groups_[k].area;
      }
      if (!(g.area > 0)) g.center = groups_[first].center;
      finish(g, [&](auto&& take) {
        for (std::size_t k = first; k < last; ++k) take(groups_[k].center, std::sqrt(groups_[k].radius_sq));
      });
    }
  }
}

double WindingNumber::exact(std::size_t begin, std::size_t end, Vec3d point) const {
  double sum = 0;
  for (std::size_t t = begin; t < end; ++t) {
    const auto [a, b, c] = surface_.corners(t);
    sum += half_solid_angle(a - point, b - point, c - point);
  }
  return sum * 2;
}

double WindingNumber::at(Vec3d point) const {
  struct Place {
    std::size_t level, group;  // of the level
  };
  std::array<Place, 16 * kFan> stack;
  std::size_t top = 0;
  stack[top++] = {level_first_.size() - 2, 0};
  double angle = 0;
  while (top > 0) {
    const Place place = stack[--top];
    const Group& g = groups_[level_first_[place.level] + place.group];
    const Vec3d to = g.center - point;
    const double distance_sq = dot(to, to);
    if (distance_sq > kFarSq * g.radius_sq) {
      angle += dot(g.area_normal, to) / (distance_sq * std::sqrt(distance_sq));
      continue;
    }
    const std::size_t first = place.group * kFan;
    if (place.level == 0) {
      angle += exact(first, std::min(first + kFan, surface_.triangles.size()), point);
      continue;
    }
    const std::size_t below = level_first_[place.level] - level_first_[place.level - 1];
    for (std::size_t k = std::min(first + kFan, below); k-- > first;) stack[top++] = {place.level - 1, k};
  }
  return angle / (4 * kPi);
}

}  // namespace lodestone::voxel
