// Where two vertices merge best, and what it costs.
#pragma once

#include "lodestone/simplify/collapse_state_detail.h"

namespace lodestone::simplify::detail {

/// The six different entries of a symmetric 3x3 matrix.
struct Sym3 {
  float xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;

  float trace() const { return xx + yy + zz; }
  Vec3f times(Vec3f v) const {
    return {xx * v.x + xy * v.y + xz * v.z, xy * v.x + yy * v.y + yz * v.z, xz * v.x + yz * v.y + zz * v.z};
  }
  float at(Vec3f v) const { return dot(v, times(v)); }
  void add_outer(Vec3f n, float w) {
    xx += w * n.x * n.x;
    xy += w * n.x * n.y;
    xz += w * n.x * n.z;
    yy += w * n.y * n.y;
    yz += w * n.y * n.z;
    zz += w * n.z * n.z;
  }
};

inline Sym3 matrix_of(const Quadric& q) { return {q.xx, q.xy, q.xz, q.yy, q.yz, q.zz}; }

struct Placement {
  Vec3f position;
  float cost = 0;    ///< sum of twice the area times squared distance, over the triangles around
  float weight = 0;  ///< sum of twice the areas: cost / weight is a mean square distance
};

/// What the triangles that have both vertices contribute to either quadric: counted once, not twice.
struct Shared {
  Sym3 matrix;
  Vec3f volume;
  void add(Vec3f a, Vec3f b, Vec3f c);
};

/// Both free: the minimum of the joint quadric, pulled a little to the midpoint (1e-6), projected along the inverse to
/// the plane that keeps the volume (Lindstrom & Turk 1998, section 4); the midpoint if that lies farther than two edges
/// away.
Placement place_freely(const Quadric& v, const Quadric& w, const Shared& shared);

/// `kept` stays where it is.
Placement place_at(const Quadric& kept, const Quadric& removed);

}  // namespace lodestone::simplify::detail
