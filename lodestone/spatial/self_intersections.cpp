#include "lodestone/spatial/self_intersections.h"

#include <algorithm>
#include <limits>

#include "lodestone/base/parallel.h"
#include "lodestone/math/box.h"
#include "lodestone/math/triangle.h"
#include "lodestone/spatial/neighbors.h"

namespace lodestone::spatial {

namespace {

double side_of(Vec3d a, Vec3d b, Vec3d c, Vec3d p) { return dot(cross(b - a, c - a), p - a); }

// Does the segment from p to q pass through the inside of the triangle?
bool passes(Vec3d p, Vec3d q, const std::array<Vec3d, 3>& t) {
  const double x = side_of(p, q, t[0], t[1]), y = side_of(p, q, t[1], t[2]), z = side_of(p, q, t[2], t[0]);
  return (x > 0 && y > 0 && z > 0) || (x < 0 && y < 0 && z < 0);
}

bool sides_pass(const std::array<Vec3d, 3>& a, const std::array<Vec3d, 3>& b, const std::array<double, 3>& a_to_b) {
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    if (a_to_b[k] * a_to_b[next] < 0 && passes(a[k], a[next], b)) return true;
  }
  return false;
}

// How far the corners of one triangle are from the other's plane, by a common factor.
std::array<double, 3> sides_of(const std::array<Vec3d, 3>& corners, const std::array<Vec3d, 3>& plane) {
  const Vec3d normal = cross(plane[1] - plane[0], plane[2] - plane[0]);
  return {dot(normal, corners[0] - plane[0]), dot(normal, corners[1] - plane[0]), dot(normal, corners[2] - plane[0])};
}

bool all_on_one_side(const std::array<double, 3>& s) {
  return (s[0] >= 0 && s[1] >= 0 && s[2] >= 0) || (s[0] <= 0 && s[1] <= 0 && s[2] <= 0);
}

bool share_a_vertex(const Triangle& a, const Triangle& b) {
  return std::any_of(a.begin(), a.end(), [&](std::uint32_t v) { return std::find(b.begin(), b.end(), v) != b.end(); });
}

}  // namespace

bool triangles_intersect(const std::array<Vec3d, 3>& a, const std::array<Vec3d, 3>& b) {
  const std::array<double, 3> a_to_b = sides_of(a, b);
  if (all_on_one_side(a_to_b)) return false;
  const std::array<double, 3> b_to_a = sides_of(b, a);
  return !all_on_one_side(b_to_a) && (sides_pass(a, b, a_to_b) || sides_pass(b, a, b_to_a));
}

std::vector<std::array<std::uint32_t, 2>> self_intersections(const Bvh& tree, std::span<const std::uint8_t> wanted,
                                                             const Task& task) {
  using Pairs = std::vector<std::array<std::uint32_t, 2>>;
  const Surface& surface = tree.surface();
  Pairs pairs = parallel_reduce(
      surface.triangles.size(), 256, task, Pairs(),
      [&](std::size_t begin, std::size_t end) {
        Pairs part;
        std::vector<std::uint32_t> near;
        for (std::size_t t = begin; t < end; ++t) {
          if (!wanted.empty() && wanted[t] == 0) continue;
          const std::array<Vec3d, 3> corners = surface.corners(t);
          Box3d box;
          for (const Vec3d& p : corners) box.add(p);
          tree.triangles_in(box, std::numeric_limits<std::size_t>::max(), near);
          for (const std::uint32_t other : near) {
            // A pair of two that are wanted is told once.
            if (other == t || (other < t && (wanted.empty() || wanted[other] != 0))) continue;
            if (share_a_vertex(surface.triangles[t], surface.triangles[other])) continue;
            if (!triangles_intersect(corners, surface.corners(other))) continue;
            const auto own = static_cast<std::uint32_t>(t);
            part.push_back({std::min(own, other), std::max(own, other)});
          }
        }
        return part;
      },
      [](Pairs a, const Pairs& b) {
        a.insert(a.end(), b.begin(), b.end());
        return a;
      });
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

std::vector<std::array<std::uint32_t, 2>> folds(const Surface& surface) {
  constexpr double kFold = -0.98480775301220806;  // cosine of 170 degrees between normals
  const std::vector<std::array<std::uint32_t, 3>> neighbors = triangle_neighbors(surface);
  std::vector<Vec3d> normals;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto [a, b, c] = surface.corners(t);
    normals.push_back(normalized(scaled_normal(a, b, c)));
  }
  std::vector<std::array<std::uint32_t, 2>> pairs;
  for (std::uint32_t t = 0; t < normals.size(); ++t) {
    for (const std::uint32_t other : neighbors[t]) {
      if (other != kNone && other > t && dot(normals[t], normals[other]) < kFold) pairs.push_back({t, other});
    }
  }
  return pairs;
}

}  // namespace lodestone::spatial
