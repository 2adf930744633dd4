#include "lodestone/math/triangle.h"

#include <algorithm>

namespace lodestone {

namespace {

Vec3d closest_on_segment(Vec3d p, Vec3d a, Vec3d b) {
  const Vec3d e = b - a;
  const double l = length_sq(e);
  return l > 0 ? a + e * std::clamp(dot(p - a, e) / l, 0.0, 1.0) : a;
}

ClosestPoint closest_on_sides(Vec3d p, Vec3d a, Vec3d b, Vec3d c) {
  ClosestPoint best{a, length_sq(p - a)};
  for (const Vec3d q : {closest_on_segment(p, a, b), closest_on_segment(p, b, c), closest_on_segment(p, c, a)}) {
    const double d = length_sq(p - q);
    if (d < best.distance_sq) best = {q, d};
  }
  return best;
}

// A needle, whose barycentric coordinates would be lost in rounding: above its inside if p is on the inner side of all
// three sides, each seen from its own corner.
ClosestPoint closest_on_needle(Vec3d p, Vec3d a, Vec3d b, Vec3d c, Vec3d n) {
  const double l = length_sq(n);
  ClosestPoint best = closest_on_sides(p, a, b, c);
  const auto within = [&](Vec3d from, Vec3d to) { return dot(cross(to - from, p - from), n) >= 0; };
  if (!(l > 0) || !within(a, b) || !within(b, c) || !within(c, a)) return best;
  const Vec3d q = p - n * (dot(p - a, n) / l);
  const double d = length_sq(p - q);
  // Where even the normal is lost, the foot may lie far off the triangle; then it is no nearer to a than to be
  // believed.
  if (d < best.distance_sq && length_sq(q - best.point) <= 1.0001 * best.distance_sq) best = {q, d};
  return best;
}

}  // namespace

ClosestPoint closest_point(Vec3d p, Vec3d a, Vec3d b, Vec3d c) {
  constexpr double kNeedleSineSq = 1e-6;
  const auto found = [&](Vec3d q) { return ClosestPoint{q, length_sq(p - q)}; };
  const Vec3d ab = b - a, ac = c - a, ap = p - a, n = cross(ab, ac);
  if (!(length_sq(n) > kNeedleSineSq * length_sq(ab) * length_sq(ac))) return closest_on_needle(p, a, b, c, n);
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return found(a);
  const Vec3d bp = p - b;
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return found(b);
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return found(a + ab * (d1 / (d1 - d3)));
  const Vec3d cp = p - c;
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return found(c);
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return found(a + ac * (d2 / (d2 - d6)));
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double sum = (d4 - d3) + (d5 - d6);
    return found(b + (c - b) * ((d4 - d3) / sum));
  }
  const double denominator = va + vb + vc;
  return found(a + ab * (vb / denominator) + ac * (vc / denominator));
}

std::array<double, 3> barycentric(Vec3d p, Vec3d a, Vec3d b, Vec3d c) {
  const Vec3d n = cross(b - a, c - a);
  const double l = length_sq(n);
  const std::array<double, 3> sides{length_sq(c - b), length_sq(a - c), length_sq(b - a)};
  const double longest = std::max({sides[0], sides[1], sides[2]});
  if (l > 1e-24 * longest * longest) {
    std::array<double, 3> w{dot(cross(b - p, c - p), n), dot(cross(c - p, a - p), n), dot(cross(a - p, b - p), n)};
    for (double& x : w) x = std::max(x, 0.0);
    const double sum = w[0] + w[1] + w[2];
    if (sum > 0) return {w[0] / sum, w[1] / sum, w[2] / sum};
  }
  if (!(longest > 0)) return {1, 0, 0};
  // Without area: along the longest side.
  const std::array<Vec3d, 3> corners{a, b, c};
  const std::size_t k = sides[0] == longest ? 0 : sides[1] == longest ? 1 : 2;  // the corner across from it
  const Vec3d from = corners[(k + 1) % 3], to = corners[(k + 2) % 3];
  const double t = std::clamp(dot(p - from, to - from) / longest, 0.0, 1.0);
  std::array<double, 3> w{};
  w[(k + 1) % 3] = 1 - t;
  w[(k + 2) % 3] = t;
  return w;
}

}  // namespace lodestone
