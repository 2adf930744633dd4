// The accumulated error of a vertex: an estimate of how far the surface there is from the original.
//
// Costs of collapses are blind in two ways. They weigh by area, so a thin tip costs next to nothing. They are
// memoryless, so small losses add up unseen. Therefore each vertex carries an estimate, and a collapse costs at least
// what the square of the estimate it leaves says (docs/papers/edge-collapse.md, "Drift").
//
// FanDistance measures from a point to the fan of triangles around a vertex, four triangles at a time. To the distance
// it adds the accumulated error at the nearest point, interpolated from the corners:
// - error_above(): the nearest triangle that the point lies above or below,
// - error_at_edges(): the nearest edge,
// - error_at(): the first if there is such a triangle, else the second.
// Sweeper::error_after() takes the largest of three: the new vertex against the old triangles, and each old vertex
// against the new triangles. For the new vertex the fan of the nearer end is asked first. That of the farther end is
// asked only where the first has no triangle above or below, or where its answer would raise the cost; the smaller of
// both counts then.
//
// An estimate, not a bound. Distances below what positions are rounded by count as 0. O(valence), without allocations
// once the buffers have grown.
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

// Four leaves side by side.
struct Leaves {
  Vec4 a, b, n;
  Float4 error_a, error_b, inverse;  // inverse of the squared length of n

  explicit Leaves(const Leaf* leaf) {
    Float4 rows[3][4];
    for (std::size_t i = 0; i < 4; ++i) {
      const auto* in = reinterpret_cast<const Float4*>(&leaf[i]);
      for (std::size_t k = 0; k < 3; ++k) rows[k][i] = in[k];
    }
    for (auto& r : rows) transpose(r[0], r[1], r[2], r[3]);
    a = {rows[0][0], rows[0][1], rows[0][2]};
    error_a = rows[0][3];
    b = {rows[1][0], rows[1][1], rows[1][2]};
    error_b = rows[1][3];
    n = {rows[2][0], rows[2][1], rows[2][2]};
    inverse = rows[2][3];
  }
};

// The nearest so far, lane by lane.
struct Nearest {
  Float4 squared = fill(3e38F), accumulated{};

  void offer(Float4 d, Float4 at) {
    const Mask nearer = d < squared;
    squared = nearer ? d : squared;
    accumulated = nearer ? at : accumulated;
  }
  float total(float rounding) const {
    std::size_t best = 0;
    for (std::size_t i = 1; i < 4; ++i) best = squared[i] < squared[best] ? i : best;
    const float distance = std::sqrt(squared[best]);
    return (distance > rounding ? distance : 0) + accumulated[best];
  }
  bool found() const { return std::min({squared[0], squared[1], squared[2], squared[3]}) < 3e38F; }
};

// Offers the nearest point of the segment from s to s + e, with accumulated errors at its ends.
void offer_segment(Nearest& nearest, const Vec4& from_s, const Vec4& e, Float4 error_s, Float4 error_e) {
  const Float4 l = dot(e, e), zero{}, one = fill(1);
  Float4 t = dot(from_s, e) / (l + fill(1e-30F));
  t = t < zero ? zero : t;
  t = t > one ? one : t;
  const Vec4 away = from_s - scaled(e, t);
  nearest.offer(dot(away, away), error_s + (error_e - error_s) * t);
}

}  // namespace

void FanDistance::pad() {
  while (size_ % 4 != 0) add(leaf_[0]);
}

bool FanDistance::error_above(Vec3f q, float apex_error, float& accumulated) const {
  const Vec4 p{fill(q.x), fill(q.y), fill(q.z)};
  const Float4 zero{}, apex = fill(apex_error);
  Nearest nearest;
  for (std::size_t i = 0; i < size_; i += 4) {
    const Leaves l(&leaf_[i]);
    const Float4 u = dot(cross(p, l.b), l.n) * l.inverse, v = dot(cross(l.a, p), l.n) * l.inverse;
    const Float4 w = 1.0F - u - v, h = dot(l.n, p);
    const Mask inside = (u >= zero) & (v >= zero) & (w >= zero) & (l.inverse > zero);
    nearest.offer(inside ? h * h * l.inverse : fill(3e38F), apex * w + l.error_a * u + l.error_b * v);
  }
  if (!nearest.found()) return false;
  accumulated = nearest.total(rounding_);
  return true;
}

float FanDistance::error_at_edges(Vec3f q, float apex_error) const {
  const Vec4 p{fill(q.x), fill(q.y), fill(q.z)};
  const Float4 apex = fill(apex_error);
  Nearest nearest;
  for (std::size_t i = 0; i < size_; i += 4) {
    const Leaves l(&leaf_[i]);
    offer_segment(nearest, p, l.a, apex, l.error_a);
    offer_segment(nearest, p, l.b, apex, l.error_b);
    offer_segment(nearest, p - l.a, l.b - l.a, l.error_a, l.error_b);
  }
  return nearest.total(rounding_);
}

float FanDistance::error_at(Vec3f q, float apex_error) const {
  float accumulated = 0;
  return error_above(q, apex_error, accumulated) ? accumulated : error_at_edges(q, apex_error);
}

// About how far from the input the surface is after a collapse.
float Sweeper::error_after(const Candidate& candidate, float enough) {
  const std::vector<Vec3f>& positions = state_.positions;
  const std::vector<float>& accumulated = state_.accumulated_error;
  const std::uint32_t k = candidate.kept, r = candidate.removed;
  const Vec3f from_k = candidate.position - positions[k], from_r = candidate.position - positions[r];
  const auto load = [&](std::uint32_t v) {
    fan_.clear();
    for (const Corner& c : v == k ? kept_ : removed_) {
      const TriangleNormal& t = state_.normals[c.triangle];
      const float inverse = t.inverse_root * t.inverse_root;
      fan_.add({positions[c.a] - positions[v], accumulated[c.a], positions[c.b] - positions[v], accumulated[c.b], t.n,
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
  const bool above = fan_.error_above(from_near, accumulated[near], most);
  if (!above) most = fan_.error_at_edges(from_near, accumulated[near]);
  if (!above || most > enough) {
    load(far);
    most = std::min(most, fan_.error_at(from_far, accumulated[far]));
  }
  fan_.clear();
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    const float l = length_sq(normals_[i]);
    fan_.add({positions[corners_[i].a] - candidate.position, 0, positions[corners_[i].b] - candidate.position, 0,
              normals_[i], l > 0 ? 1 / l : 0});
  }
  fan_.pad();
  for (const std::uint32_t v : {k, r}) {
    most = std::max(most, accumulated[v] + fan_.error_at(positions[v] - candidate.position, 0));
  }
  return most;
}

}  // namespace lodestone::simplify::detail
