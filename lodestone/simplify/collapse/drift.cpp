// How far the surface drifts from the original: each vertex carries an estimate, which every collapse adds to.
//
// A collapse moves the surface by how far the new vertex lies from the old triangles, and the old vertices from the new
// triangles. To each distance comes the drift that was there before, interpolated. Costs weigh by area, so they are
// blind to thin tips, and memoryless, so they forget what was lost before; the drift sees both.
#include <algorithm>
#include <cmath>

#include "lodestone/simplify/collapse/sweep_detail.h"

namespace lodestone::simplify::detail {

namespace {

using Mask = Int4;

struct Vec4 {
  Float4 x, y, z;
};
Vec4 cross(const Vec4& a, const Vec4& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
Float4 dot(const Vec4& a, const Vec4& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vec4 operator-(const Vec4& a, const Vec4& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vec4 scaled(const Vec4& a, Float4 s) { return {a.x * s, a.y * s, a.z * s}; }
Float4 fill(float f) { return Float4{f, f, f, f}; }

// Four leaves side by side.
struct Leaves {
  Vec4 a, b, n;
  Float4 drift_a, drift_b, inverse;  // inverse of the squared length of n

  explicit Leaves(const Leaf* leaf) {
    Float4 rows[3][4];
    for (std::size_t i = 0; i < 4; ++i) {
      const auto* in = reinterpret_cast<const Float4*>(&leaf[i]);
      for (std::size_t k = 0; k < 3; ++k) rows[k][i] = in[k];
    }
    for (auto& r : rows) transpose(r[0], r[1], r[2], r[3]);
    a = {rows[0][0], rows[0][1], rows[0][2]};
    drift_a = rows[0][3];
    b = {rows[1][0], rows[1][1], rows[1][2]};
    drift_b = rows[1][3];
    n = {rows[2][0], rows[2][1], rows[2][2]};
    inverse = rows[2][3];
  }
};

// The nearest so far, lane by lane.
struct Nearest {
  Float4 squared = fill(3e38F), drift{};

  void offer(Float4 d, Float4 at) {
    const Mask nearer = d < squared;
    squared = nearer ? d : squared;
    drift = nearer ? at : drift;
  }
  float total(float rounding) const {
    std::size_t best = 0;
    for (std::size_t i = 1; i < 4; ++i) best = squared[i] < squared[best] ? i : best;
    const float distance = std::sqrt(squared[best]);
    return (distance > rounding ? distance : 0) + drift[best];
  }
  bool found() const { return std::min({squared[0], squared[1], squared[2], squared[3]}) < 3e38F; }
};

// Offers the nearest point of the segment from s to s + e, with drifts at its ends.
void offer_segment(Nearest& nearest, const Vec4& from_s, const Vec4& e, Float4 drift_s, Float4 drift_e) {
  const Float4 l = dot(e, e), zero{}, one = fill(1);
  Float4 t = dot(from_s, e) / (l + fill(1e-30F));
  t = t < zero ? zero : t;
  t = t > one ? one : t;
  const Vec4 away = from_s - scaled(e, t);
  nearest.offer(dot(away, away), drift_s + (drift_e - drift_s) * t);
}

}  // namespace

void FanDistance::pad() {
  while (size_ % 4 != 0) add(leaf_[0]);
}

bool FanDistance::drift_above(Vec3f q, float apex_drift, float& drift) const {
  const Vec4 p{fill(q.x), fill(q.y), fill(q.z)};
  const Float4 zero{}, apex = fill(apex_drift);
  Nearest nearest;
  for (std::size_t i = 0; i < size_; i += 4) {
    const Leaves l(&leaf_[i]);
    const Float4 u = dot(cross(p, l.b), l.n) * l.inverse, v = dot(cross(l.a, p), l.n) * l.inverse;
    const Float4 w = 1.0F - u - v, h = dot(l.n, p);
    const Mask inside = (u >= zero) & (v >= zero) & (w >= zero) & (l.inverse > zero);
    nearest.offer(inside ? h * h * l.inverse : fill(3e38F), apex * w + l.drift_a * u + l.drift_b * v);
  }
  if (!nearest.found()) return false;
  drift = nearest.total(rounding_);
  return true;
}

float FanDistance::drift_at_edges(Vec3f q, float apex_drift) const {
  const Vec4 p{fill(q.x), fill(q.y), fill(q.z)};
  const Float4 apex = fill(apex_drift);
  Nearest nearest;
  for (std::size_t i = 0; i < size_; i += 4) {
    const Leaves l(&leaf_[i]);
    offer_segment(nearest, p, l.a, apex, l.drift_a);
    offer_segment(nearest, p, l.b, apex, l.drift_b);
    offer_segment(nearest, p - l.a, l.b - l.a, l.drift_a, l.drift_b);
  }
  return nearest.total(rounding_);
}

float FanDistance::drift_at(Vec3f q, float apex_drift) const {
  float drift = 0;
  return drift_above(q, apex_drift, drift) ? drift : drift_at_edges(q, apex_drift);
}

// About how far from the input the surface is after a collapse.
float Sweeper::drift_after(const Candidate& candidate, float enough) {
  const std::vector<Vec3f>& positions = state_.positions;
  const std::vector<float>& drift = state_.drift;
  const std::uint32_t k = candidate.kept, r = candidate.removed;
  const Vec3f from_k = candidate.position - positions[k], from_r = candidate.position - positions[r];
  const auto load = [&](std::uint32_t v) {
    fan_.clear();
    for (const Corner& c : v == k ? kept_ : removed_) {
      const TriangleNormal& t = state_.normals[c.triangle];
      const float inverse = t.inverse_root * t.inverse_root;
      fan_.add({positions[c.a] - positions[v], drift[c.a], positions[c.b] - positions[v], drift[c.b], t.n,
                inverse * inverse});
    }
    fan_.pad();
  };
  // Most positions are above or below a triangle of the end that they are nearer to.
  const bool nearer_k = length_sq(from_k) <= length_sq(from_r);
  const std::uint32_t near = nearer_k ? k : r, far = nearer_k ? r : k;
  const Vec3f from_near = nearer_k ? from_k : from_r, from_far = nearer_k ? from_r : from_k;
  float most = 0;
  load(near);
  const bool above = fan_.drift_above(from_near, drift[near], most);
  if (!above) most = fan_.drift_at_edges(from_near, drift[near]);
  if (!above || most > enough) {
    load(far);
    most = std::min(most, fan_.drift_at(from_far, drift[far]));
  }
  fan_.clear();
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    const float l = length_sq(normals_[i]);
    fan_.add({positions[corners_[i].a] - candidate.position, 0, positions[corners_[i].b] - candidate.position, 0,
              normals_[i], l > 0 ? 1 / l : 0});
  }
  fan_.pad();
  for (const std::uint32_t v : {k, r}) {
    most = std::max(most, drift[v] + fan_.drift_at(positions[v] - candidate.position, 0));
  }
  return most;
}

}  // namespace lodestone::simplify::detail
