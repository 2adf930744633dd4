#include "lodestone/io/plain/polygon.h"

#include <cmath>

#include "lodestone/io/plain/polygon_ears_detail.h"

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

}  // namespace

struct PolygonCutter::Scratch {
  EarClipper ears;
  std::vector<std::uint32_t> twin;
};

PolygonCutter::PolygonCutter() : scratch_(std::make_unique<Scratch>()) {}
PolygonCutter::~PolygonCutter() = default;
PolygonCutter::PolygonCutter(PolygonCutter&&) noexcept = default;
PolygonCutter& PolygonCutter::operator=(PolygonCutter&&) noexcept = default;

std::span<const CornerTriple> PolygonCutter::cut(std::span<const Vec3d> corners) {
  triples_.clear();
  if (corners.size() == 3) {
    triples_.push_back({0, 1, 2});
  } else if (corners.size() == 4) {
    quad(corners);
  } else if (corners.size() > 4) {
    if (project(corners)) {
      scratch_->twin.clear();
      const PolygonTriangles triangles{triples_, scratch_->twin};
      scratch_->ears.clip(flat_, triangles);
      turn_diagonals(flat_, triangles);
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

}  // namespace lodestone::io
