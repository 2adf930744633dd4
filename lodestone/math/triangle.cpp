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

}  // namespace

ClosestPoint closest_point(Vec3d p, Vec3d a, Vec3d b, Vec3d c) {
  const auto found = [&](Vec3d q) { return ClosestPoint{q, length_sq(p - q)}; };
  const Vec3d ab = b - a, ac = c - a, ap = p - a;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return found(a);
  const Vec3d bp = p - b;
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return found(b);
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0)
    return d1 - d3 > 0 ? found(a + ab * (d1 / (d1 - d3))) : closest_on_sides(p, a, b, c);
  const Vec3d cp = p - c;
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return found(c);
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0)
    return d2 - d6 > 0 ? found(a + ac * (d2 / (d2 - d6))) : closest_on_sides(p, a, b, c);
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double sum = (d4 - d3) + (d5 - d6);
    return sum > 0 ? found(b + (c - b) * ((d4 - d3) / sum)) : closest_on_sides(p, a, b, c);
  }
  // A needle's interior case is lost in rounding: let its sides decide when they are nearer.
  const double denominator = va + vb + vc;
  if (!(denominator > 1e-12 * (length_sq(ab) * length_sq(ac)))) return closest_on_sides(p, a, b, c);
  return found(a + ab * (vb / denominator) + ac * (vc / denominator));
}

}  // namespace lodestone
