#include "lodestone/io/polygon.h"

#include <cmath>

namespace lodestone::io {

namespace {

// Normal of a closed polygon, its length twice the projected area; right for concave and bent ones.
Vec3d newell_normal(std::span<const Vec3d> corners) {
  Vec3d normal{};
  const Vec3d origin = corners[0];  // near the polygon, so that far coordinates lose nothing
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    normal += cross(corners[i] - origin, corners[i + 1] - origin);
  }
  return normal;
}

double cross2(Vec2d a, Vec2d b, Vec2d c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

}  // namespace

std::span<const CornerTriple> PolygonCutter::cut(std::span<const Vec3d> corners) {
  triples_.clear();
  if (corners.size() == 3) {
    triples_.push_back({0, 1, 2});
  } else if (corners.size() == 4) {
    quad(corners);
  } else if (corners.size() > 4) {
    if (project(corners)) {
      clip_ears();
    } else {
      fan(corners.size());
    }
  }
  return triples_;
}

void PolygonCutter::fan(std::size_t corners) {
  for (std::uint32_t i = 1; i + 1 < corners; ++i) triples_.push_back({0, i, i + 1});
}

// The diagonal 0-2 unless only 1-3 leaves both halves facing the same way.
void PolygonCutter::quad(std::span<const Vec3d> p) {
  const Vec3d n = newell_normal(p);
  const auto faces_out = [&](std::size_t a, std::size_t b, std::size_t c) {
    return dot(cross(p[b] - p[a], p[c] - p[a]), n) > 0;
  };
  const bool first = faces_out(0, 1, 2) && faces_out(0, 2, 3);
  if (!first && faces_out(1, 2, 3) && faces_out(1, 3, 0)) {
    triples_.push_back({1, 2, 3});
    triples_.push_back({1, 3, 0});
  } else {
    fan(4);
  }
}

// Into the plane of the normal, counter-clockwise. False without a normal.
bool PolygonCutter::project(std::span<const Vec3d> corners) {
  const Vec3d normal = normalized(newell_normal(corners));
  if (!(length_sq(normal) > 0.5)) return false;  // also when not finite
  const Vec3d axis = std::abs(normal.x) < 0.6 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  const Vec3d u = normalized(cross(axis, normal));
  const Vec3d v = cross(normal, u);
  flat_.resize(corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3d d = corners[i] - corners[0];
    flat_[i] = {dot(d, u), dot(d, v)};
  }
  return true;
}

double PolygonCutter::area_at(std::uint32_t corner) const {
  return cross2(flat_[before_[corner]], flat_[corner], flat_[after_[corner]]);
}

void PolygonCutter::update(std::uint32_t corner) { is_blunt_[corner] = area_at(corner) > 0 ? 0 : 1; }

// A convex corner whose triangle holds no blunt corner of the rest, on its sides neither. Corners at the same place as
// one of the triangle's are let in: polygons with bridges to their holes have such.
bool PolygonCutter::is_ear(std::uint32_t corner) {
  if (is_blunt_[corner]) return false;
  const Vec2d a = flat_[before_[corner]], b = flat_[corner], c = flat_[after_[corner]];
  std::size_t kept = 0;
  bool ear = true;
  for (std::size_t i = 0; i < blunt_.size(); ++i) {
    const std::uint32_t other = blunt_[i];
    if (!is_blunt_[other]) continue;  // convex or clipped since: drops out of the list
    blunt_[kept++] = other;
    if (!ear) continue;
    const Vec2d p = flat_[other];
    if (p == a || p == b || p == c) continue;
    if (cross2(a, b, p) >= 0 && cross2(b, c, p) >= 0 && cross2(c, a, p) >= 0) ear = false;
  }
  budget_ -= std::min<std::uint64_t>(budget_, blunt_.size() + 1);
  blunt_.resize(kept);
  return ear;
}

void PolygonCutter::clip_ears() {
  const auto n = static_cast<std::uint32_t>(flat_.size());
  before_.resize(n);
  after_.resize(n);
  is_blunt_.assign(n, 0);
  blunt_.clear();
  for (std::uint32_t i = 0; i < n; ++i) {
    before_[i] = i == 0 ? n - 1 : i - 1;
    after_[i] = i + 1 == n ? 0 : i + 1;
  }
  for (std::uint32_t i = 0; i < n; ++i) update(i);
  for (std::uint32_t i = 0; i < n; ++i) {
    if (is_blunt_[i]) blunt_.push_back(i);
  }
  constexpr std::uint64_t kStepsPerCorner = 2048;
  budget_ = kStepsPerCorner * n;

  std::uint32_t left = n, corner = 0, refused = 0;
  while (left > 3) {
    // After a round without an ear the polygon crosses itself: any corner goes, as in a fan.
    const bool forced = refused >= left || budget_ == 0;
    if (!forced && !is_ear(corner)) {
      corner = after_[corner];
      ++refused;
      continue;
    }
    const std::uint32_t a = before_[corner], c = after_[corner];
    triples_.push_back({a, corner, c});
    after_[a] = c;
    before_[c] = a;
    is_blunt_[corner] = 0;
    const auto renew = [&](std::uint32_t at) {
      const bool was = is_blunt_[at] != 0;
      update(at);
      if (!was && is_blunt_[at]) blunt_.push_back(at);
    };
    renew(a);
    renew(c);
    --left;
    refused = 0;
    corner = after_[c];  // not the neighbour: that would make a fan of slivers
  }
  triples_.push_back({before_[corner], corner, after_[corner]});
}

}  // namespace lodestone::io
