// Closest points for thousands of points at once, looked up in groups of eight.
//
// find():
// 1. sort() puts the points along a Hilbert curve [skilling-2004] through their box, so that eight in a row lie near
//    each other.
// 2. find_group() looks up once which triangles could be nearest to any of the eight: those in a box around the group,
//    enlarged by somewhat more (kFarther) than the largest distance in the group before.
// 3. test_near() tests these triangles against four points at a time in single precision. Each distance becomes an
//    interval; that of a sliver, whose plane single precision does not know (kSliver), begins at 0.
// 4. Back in find_group(), the few triangles whose interval reaches below the best upper bound are tested in double.
// Groups that meet too many triangles, and those that single precision can't hold, ask the tree point by point.
//
// Single precision decides only what is left out, with kRounding as its bound: distances are those of Bvh::closest().
// Groups are cut by the caller's chunks, so which of equally near triangles is named does not depend on threads either.
// O(log n) a point as a rule, of which a group shares the most.
#include "lodestone/spatial/closest_batch.h"

#include <algorithm>
#include <cmath>

#include "lodestone/math/box.h"
#include "lodestone/math/float4.h"
#include "lodestone/math/triangle.h"
#include "lodestone/spatial/hilbert.h"

namespace lodestone::spatial {

namespace {

// How much farther to look than the group before had to.
constexpr double kFarther = 1.6;

// By how much single precision may be off: a share of the largest coordinate of a triangle or point, as seen from the
// group's middle.
constexpr float kRounding = 4e-6F;

// Where twice the area is less than this share of the longest side squared, single precision does not know the plane.
constexpr float kSliver = 1e-2F;

Float4 smaller(Float4 a, Float4 b) { return a < b ? a : b; }
Float4 clamped(Float4 a) {
  const Float4 positive = a > 0.0F ? a : fill(0);
  return positive < 1.0F ? positive : fill(1);
}

struct Vec4 {
  Float4 x, y, z;
};
Vec4 operator-(const Vec4& p, Vec3f a) { return {p.x - fill(a.x), p.y - fill(a.y), p.z - fill(a.z)}; }
Float4 dot(const Vec4& p, Vec3f a) { return p.x * fill(a.x) + p.y * fill(a.y) + p.z * fill(a.z); }
Float4 length_sq(const Vec4& p) { return p.x * p.x + p.y * p.y + p.z * p.z; }

// One triangle, made ready for many points.
struct Ready {
  Vec3f corner[3], side[3];
  Vec3f inner[3];           // across each side, in the plane, towards the inside
  float inverse_square[3];  // of the sides' lengths
  Vec3f unit_normal;
  float rounding;
  bool sliver;
};

// `reach`: how far the points are from the middle.
Ready ready(const std::array<Vec3d, 3>& corners, Vec3d middle, float reach) {
  Ready r;
  float largest = reach, longest_sq = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    r.corner[k] = to_float(corners[k] - middle);
    largest = std::max({largest, std::abs(r.corner[k].x), std::abs(r.corner[k].y), std::abs(r.corner[k].z)});
  }
  for (std::size_t k = 0; k < 3; ++k) {
    r.side[k] = r.corner[(k + 1) % 3] - r.corner[k];
    const float square = length_sq(r.side[k]);
    longest_sq = std::max(longest_sq, square);
    r.inverse_square[k] = square > 0 ? 1 / square : 0;
  }
  const Vec3f normal = cross(r.side[0], r.side[1]);
  const float twice_area = length(normal);
  r.sliver = !(twice_area > kSliver * longest_sq);
  r.unit_normal = r.sliver ? Vec3f{} : normal / twice_area;
  for (std::size_t k = 0; k < 3; ++k) r.inner[k] = cross(r.unit_normal, r.side[k]);
  r.rounding = kRounding * largest;
  return r;
}

// Squared distances of four points to a triangle.
Float4 distance_sq(const Ready& t, const Vec4& p) {
  Float4 to_sides = fill(3e38F);
  auto inside = to_sides > 0.0F;
  Float4 height = fill(0);
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec4 d = p - t.corner[k];
    if (k == 0) height = dot(d, t.unit_normal);
    const Float4 s = clamped(dot(d, t.side[k]) * fill(t.inverse_square[k]));
    const Vec4 off{d.x - s * fill(t.side[k].x), d.y - s * fill(t.side[k].y), d.z - s * fill(t.side[k].z)};
    to_sides = smaller(to_sides, length_sq(off));
    inside &= dot(d, t.inner[k]) >= 0.0F;
  }
  return t.sliver ? to_sides : inside ? height * height : to_sides;
}

Float4 root(Float4 a) { return Float4{std::sqrt(a[0]), std::sqrt(a[1]), std::sqrt(a[2]), std::sqrt(a[3])}; }

}  // namespace

// Along a Hilbert curve through their box, as fine as the groups need it; ties by number. Two rounds of counting.
void ClosestBatch::sort(std::span<const Vec3d> points) {
  constexpr unsigned kBits = 6, kDigits = 9;
  constexpr std::uint32_t kValues = 1U << kDigits;
  static_assert(3 * kBits == 2 * kDigits);
  Box3d box;
  for (const Vec3d& p : points) box.add(p);
  const Vec3d size = box.size();
  const double extent = std::max({size.x, size.y, size.z}), cells = extent > 0 ? ((1U << kBits) - 1) / extent : 0;
  keys_.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3d at = (points[i] - box.min) * cells;
    keys_[i] = static_cast<std::uint32_t>(hilbert_key<kBits>(
        static_cast<std::uint32_t>(at.x), static_cast<std::uint32_t>(at.y), static_cast<std::uint32_t>(at.z)));
  }
  order_.resize(points.size());
  half_sorted_.resize(points.size());
  const auto round = [&](unsigned shift, auto&& number, std::vector<std::uint32_t>& into) {
    std::array<std::uint32_t, kValues + 1> first{};
    for (const std::uint32_t key : keys_) ++first[((key >> shift) & (kValues - 1)) + 1];
    for (std::size_t d = 1; d <= kValues; ++d) first[d] += first[d - 1];
    for (std::size_t i = 0; i < points.size(); ++i) {
      const std::uint32_t n = number(i);
      into[first[(keys_[n] >> shift) & (kValues - 1)]++] = n;
    }
  };
  round(
      0, [](std::size_t i) { return static_cast<std::uint32_t>(i); }, half_sorted_);
  round(
      kDigits, [&](std::size_t i) { return half_sorted_[i]; }, order_);
}

bool ClosestBatch::find_group(std::span<const Vec3d> points, Group group, std::span<Nearest> closest) {
  Box3d box;
  for (const std::uint32_t i : group) box.add(points[i]);
  const Vec3d middle = box.center();
  const auto reach = static_cast<float>(length(box.size()) / 2);
  if (within_ < 0) within_ = kFarther * std::sqrt(tree_.closest(middle, hint_).distance_sq);
  float coordinates[3][kGroup];
  for (std::size_t i = 0; i < kGroup; ++i) {
    const Vec3f d = to_float(points[group[i]] - middle);
    for (std::size_t k = 0; k < 3; ++k) coordinates[k][i] = d[k];
  }
  // Groups are about as far away as the one before; those that are farther are looked up once more.
  while (true) {
    const double within = within_, size = within + static_cast<double>(reach);
    if (!(size > 1e-12 && size < 1e12)) return false;  // squares would leave the range of single precision
    Box3d around = box;
    around.min -= {within, within, within};
    around.max += {within, within, within};
    if (!tree_.triangles_in(around, kMostTriangles, near_)) return false;
    const float farthest = test_near(coordinates, middle, reach);
    if (!(farthest < 1e12F)) return false;
    within_ = static_cast<double>(farthest) * kFarther;
    if (static_cast<double>(farthest) <= within) break;
  }
  for (std::size_t i = 0; i < kGroup; ++i) {
    Nearest best;
    for (std::size_t n = 0; n < near_.size(); ++n) {
      if (lowest_[n][i] > highest_[i]) continue;
      const auto [a, b, c] = tree_.surface().corners(near_[n]);
      const ClosestPoint found = closest_point(points[group[i]], a, b, c);
      if (found.distance_sq < best.distance_sq || (found.distance_sq == best.distance_sq && near_[n] < best.triangle)) {
        best = {near_[n], found.point, found.distance_sq};
      }
    }
    closest[group[i]] = best;
  }
  return true;
}

// Writes the distances of the group's points to the triangles of near_, as intervals, to lowest_ and highest_. Returns
// the largest of highest_.
float ClosestBatch::test_near(const float (&coordinates)[3][kGroup], Vec3d middle, float reach) {
  Vec4 p[kGroup / 4];
  Float4 highest[kGroup / 4];
  for (std::size_t h = 0; h < kGroup / 4; ++h) {
    const auto four = [&](const float* v) { return Float4{v[4 * h], v[4 * h + 1], v[4 * h + 2], v[4 * h + 3]}; };
    p[h] = {four(coordinates[0]), four(coordinates[1]), four(coordinates[2])};
    highest[h] = fill(3e38F);
  }
  for (std::size_t n = 0; n < near_.size(); ++n) {
    const Ready t = ready(tree_.surface().corners(near_[n]), middle, reach);
    for (std::size_t h = 0; h < kGroup / 4; ++h) {
      const Float4 d = root(distance_sq(t, p[h]));
      highest[h] = smaller(highest[h], d + fill(t.rounding));
      const Float4 low = t.sliver ? fill(0) : d - fill(t.rounding);
      for (std::size_t i = 0; i < 4; ++i) lowest_[n][4 * h + i] = low[i];
    }
  }
  float farthest = 0;
  for (std::size_t i = 0; i < kGroup; ++i) {
    highest_[i] = highest[i / 4][i % 4];
    farthest = std::max(farthest, highest_[i]);
  }
  return farthest;
}

void ClosestBatch::find(std::span<const Vec3d> points, std::span<Nearest> closest) {
  sort(points);
  for (std::size_t i = 0; i < points.size(); i += kGroup) {
    const Group group = Group(order_).subspan(i, std::min(kGroup, points.size() - i));
    if (group.size() == kGroup) {
      if (find_group(points, group, closest)) continue;
      within_ = -1;
    }
    for (const std::uint32_t k : group) {
      closest[k] = tree_.closest(points[k], hint_);
      hint_ = closest[k].triangle;
    }
  }
}

}  // namespace lodestone::spatial
