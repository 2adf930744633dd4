#include "lodestone/simplify/collapse_solve_detail.h"

namespace lodestone::simplify::detail {

namespace {

// L D L^T of a symmetric positive definite matrix. The regularised matrices here always are.
struct Factored {
  float d0, d1, d2, l10, l20, l21;

  explicit Factored(const Sym3& a) {
    d0 = a.xx;
    l10 = a.xy / d0;
    l20 = a.xz / d0;
    d1 = a.yy - l10 * a.xy;
    l21 = (a.yz - l20 * a.xy) / d1;
    d2 = a.zz - l20 * a.xz - l21 * l21 * d1;
  }
  Vec3f solve(Vec3f b) const {
    const float y1 = b.y - l10 * b.x;
    const float y2 = b.z - l20 * b.x - l21 * y1;
    const float x2 = y2 / d2;
    const float x1 = y1 / d1 - l21 * x2;
    return {b.x / d0 - l10 * x1 - l20 * x2, x1, x2};
  }
};

constexpr float kMidpointPull = 1e-6F;

}  // namespace

void Shared::add(Vec3f a, Vec3f b, Vec3f c) {
  const Vec3f n = cross(b - a, c - a);
  const float l = length(n);
  if (!(l > 0)) return;
  matrix.add_outer(n, 1 / l);
  volume += n;
}

Placement place_freely(const Quadric& v, const Quadric& w, const Shared& shared) {
  const Vec3f e = w.position - v.position;
  Sym3 a0 = matrix_of(v);
  const Sym3 a1 = matrix_of(w);
  a0.xx -= shared.matrix.xx;
  a0.xy -= shared.matrix.xy;
  a0.xz -= shared.matrix.xz;
  a0.yy -= shared.matrix.yy;
  a0.yz -= shared.matrix.yz;
  a0.zz -= shared.matrix.zz;
  Sym3 a{a0.xx + a1.xx, a0.xy + a1.xy, a0.xz + a1.xz, a0.yy + a1.yy, a0.yz + a1.yz, a0.zz + a1.zz};
  const float weight = a.trace();
  const float pull = kMidpointPull * weight;
  a.xx += pull;
  a.yy += pull;
  a.zz += pull;
  const Vec3f middle = e * 0.5F;
  Vec3f x = middle;
  if (weight > 0) {
    const Factored f(a);
    const Vec3f best = f.solve(a1.times(e) + middle * pull);
    const Vec3f g = v.volume + w.volume - shared.volume;
    const Vec3f h = f.solve(g);
    const float gh = dot(g, h);
    const float gap = dot(w.volume, e) - dot(g, best);
    const Vec3f moved = gh > 0 ? best + h * (gap / gh) : best;
    if (length_sq(moved - middle) <= 4 * length_sq(e)) x = moved;  // false for NaN as well
  }
  const float cost = a0.at(x) + a1.at(x - e);
  return {v.position + x, cost > 0 ? cost : 0, weight};
}

Placement place_at(const Quadric& kept, const Quadric& removed) {
  const Sym3 a = matrix_of(removed);
  const float cost = a.at(kept.position - removed.position);
  return {kept.position, cost > 0 ? cost : 0, a.trace()};
}

}  // namespace lodestone::simplify::detail
