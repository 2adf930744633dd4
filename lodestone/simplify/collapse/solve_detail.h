// Where two vertices merge best, and what it costs: one kernel for one edge or four at once, with the same bits.
#pragma once

#include "lodestone/simplify/collapse/candidates_detail.h"

namespace lodestone::simplify::detail {

inline float select(bool condition, float a, float b) { return condition ? a : b; }
inline Float4 select(Int4 condition, Float4 a, Float4 b) { return condition ? a : b; }

/// F is float or Float4. Vectors and symmetric matrices as plain members, so that both read the same.
template <class F>
struct Vec {
  F x, y, z;
};

template <class F>
struct Sym3 {
  F xx, xy, xz, yy, yz, zz;
};

/// Everything that the placement of an edge (v, w) depends on.
template <class F>
struct EdgeTerms {
  Sym3<F> a0, a1;     ///< quadrics of v and w, each about its own vertex
  Vec<F> g0, g1;      ///< their volume vectors
  Vec<F> n[2];        ///< cross products of the (at most two) triangles that have both, zero where there is none
  F inverse_root[2];  ///< of their lengths
  Vec<F> edge;        ///< w - v
};

template <class F>
struct EdgePlacement {
  Vec<F> position;  ///< relative to v
  F mean_square;    ///< of the distances to the planes of the triangles around, each weighed
  F cost;           ///< sum of squared distances times twice the area to the power of 1.5, over the triangles around
};

template <class F>
F dot(const Vec<F>& a, const Vec<F>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <class F>
Vec<F> times(const Sym3<F>& m, const Vec<F>& v) {
  return {m.xx * v.x + m.xy * v.y + m.xz * v.z, m.xy * v.x + m.yy * v.y + m.yz * v.z,
          m.xz * v.x + m.yz * v.y + m.zz * v.z};
}

/// L D L^T of a symmetric positive definite matrix. The regularised matrices here always are.
template <class F>
struct Factored {
  F i0, i1, i2, l10, l20, l21;  // i: inverses of D

  explicit Factored(const Sym3<F>& a) {
    i0 = 1.0F / a.xx;
    l10 = a.xy * i0;
    l20 = a.xz * i0;
    const F d1 = a.yy - l10 * a.xy;
    i1 = 1.0F / d1;
    l21 = (a.yz - l20 * a.xy) * i1;
    i2 = 1.0F / (a.zz - l20 * a.xz - l21 * l21 * d1);
  }
  Vec<F> solve(const Vec<F>& b) const {
    const F y1 = b.y - l10 * b.x;
    const F y2 = b.z - l20 * b.x - l21 * y1;
    const F x2 = y2 * i2;
    const F x1 = y1 * i1 - l21 * x2;
    return {b.x * i0 - l10 * x1 - l20 * x2, x1, x2};
  }
};

/// Both ends free: the minimum of the joint quadric, pulled a little to the midpoint (1e-6 of the trace), projected
/// along the inverse to the plane that keeps the volume (Lindstrom & Turk 1998, section 4); the midpoint if that lies
/// farther than two edges away. Triangles that have both vertices count once.
template <class F>
EdgePlacement<F> place_freely(const EdgeTerms<F>& in) {
  Sym3<F> a0 = in.a0;
  Vec<F> g{in.g0.x + in.g1.x, in.g0.y + in.g1.y, in.g0.z + in.g1.z};
  for (int t = 0; t < 2; ++t) {
    const Vec<F>& n = in.n[t];
    const F ux = n.x * in.inverse_root[t], uy = n.y * in.inverse_root[t], uz = n.z * in.inverse_root[t];
    a0.xx -= n.x * ux;
    a0.xy -= n.x * uy;
    a0.xz -= n.x * uz;
    a0.yy -= n.y * uy;
    a0.yz -= n.y * uz;
    a0.zz -= n.z * uz;
    g.x -= n.x;
    g.y -= n.y;
    g.z -= n.z;
  }
  const Sym3<F>& a1 = in.a1;
  const Vec<F>& e = in.edge;
  Sym3<F> a{a0.xx + a1.xx, a0.xy + a1.xy, a0.xz + a1.xz, a0.yy + a1.yy, a0.yz + a1.yz, a0.zz + a1.zz};
  const F trace = a.xx + a.yy + a.zz + 1e-24F;  // what the triangles weigh
  const F pull = trace * 1e-6F;
  a.xx += pull;
  a.yy += pull;
  a.zz += pull;
  const Vec<F> middle{e.x * 0.5F, e.y * 0.5F, e.z * 0.5F};
  const Vec<F> a1e = times(a1, e);
  const Factored<F> f(a);
  const Vec<F> best = f.solve({a1e.x + middle.x * pull, a1e.y + middle.y * pull, a1e.z + middle.z * pull});
  const Vec<F> h = f.solve(g);
  const F gh = dot(g, h);
  const F gap = dot(in.g1, e) - dot(g, best);
  const F zero = gh * 0.0F;
  const F step = select(gh > 0.0F, gap / gh, zero);
  Vec<F> x{best.x + h.x * step, best.y + h.y * step, best.z + h.z * step};
  const Vec<F> away{x.x - middle.x, x.y - middle.y, x.z - middle.z};
  const auto near = dot(away, away) <= 4.0F * dot(e, e);  // false for NaN as well
  x = {select(near, x.x, middle.x), select(near, x.y, middle.y), select(near, x.z, middle.z)};
  const Vec<F> y{x.x - e.x, x.y - e.y, x.z - e.z};
  const F cost = dot(x, times(a0, x)) + dot(y, times(a1, y));
  const F positive = select(cost > 0.0F, cost, cost - cost);
  return {x, positive / trace, positive};  // +0, never -0: bins are made of bits
}

struct Placement {
  Vec3f position;
  float cost = 0;
};

inline Sym3<float> matrix_of(const Quadric& q) { return {q.xx, q.xy, q.zx, q.yy, q.yz, q.zz}; }

/// `kept` stays where it is.
inline Placement place_at(const Quadric& kept, const Quadric& removed) {
  const Sym3<float> a = matrix_of(removed);
  const Vec3f e = kept.position() - removed.position();
  const Vec<float> d{e.x, e.y, e.z};
  const float cost = dot(d, times(a, d));
  return {kept.position(), cost > 0 ? cost : 0};
}

}  // namespace lodestone::simplify::detail
