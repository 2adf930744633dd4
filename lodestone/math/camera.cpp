#include "lodestone/math/camera.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "lodestone/math/angle.h"

namespace lodestone {

namespace {

// The part of `a` at right angles to the unit vector `along`.
Vec3d without(Vec3d a, Vec3d along) { return a - along * dot(a, along); }

// A unit vector at right angles to `along`, as near to `wish` as can be.
Vec3d upright(Vec3d wish, Vec3d along) {
  for (const Vec3d candidate : {wish, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}}) {
    const Vec3d part = without(normalized(candidate), along);
    if (length_sq(part) > 1e-12) return normalized(part);
  }
  return normalized(without({1, 0, 0}, along));
}

void set_directions(Camera& camera, Vec3d forward, Vec3d up) {
  camera.forward = normalized(forward);
  if (camera.forward == Vec3d{}) camera.forward = {0, 0, -1};
  camera.up = upright(up, camera.forward);
  camera.right = cross(camera.forward, camera.up);
}

double half_height_at_one(const Lens& lens) { return sin_cos_degrees(lens.fov_degrees / 2).tan(); }

// Directions of a camera that looks from these angles.
Camera turned(const ViewAngles& angles, Vec3d up) {
  const Vec3d axis = normalized(up) == Vec3d{} ? Vec3d{0, 1, 0} : normalized(up);
  const Vec3d side = upright(std::abs(axis.x) < 0.9 ? Vec3d{1, 0, 0} : Vec3d{0, -1, 0}, axis);
  const Vec3d front = cross(side, axis);
  const SinCos azimuth = sin_cos_degrees(angles.azimuth_degrees), elevation = sin_cos_degrees(angles.elevation_degrees);
  const Vec3d around = front * azimuth.cos + side * azimuth.sin;
  Camera camera;
  // Up is the derivative of the direction by the elevation: it serves straight from above too.
  set_directions(camera, -(around * elevation.cos + axis * elevation.sin),
                 axis * elevation.cos - around * elevation.sin);
  return camera;
}

// How far points reach to both sides, as seen by an eye that may move sideways: at distance d behind the origin all
// are within the view's slope when it stands between highest - slope * d and lowest + slope * d.
struct Reach {
  double highest = -std::numeric_limits<double>::infinity(), lowest = std::numeric_limits<double>::infinity();
  void add(double across, double depth, double slope) {
    highest = std::max(highest, across - slope * depth);
    lowest = std::min(lowest, across + slope * depth);
  }
  double middle() const { return (highest + lowest) / 2; }
  double half() const { return (highest - lowest) / 2; }
};

}  // namespace

std::optional<ViewAngles> named_view(std::string_view name) {
  constexpr std::pair<std::string_view, ViewAngles> kViews[] = {{"front", {0, 0}},
                                                                {"back", {180, 0}},
                                                                {"left", {-90, 0}},
                                                                {"right", {90, 0}},
                                                                {"top", {0, 90}},
                                                                {"bottom", {0, -90}},
                                                                {"iso", {45, 35.264389682754654}}};
  for (const auto& [known, angles] : kViews) {
    if (known == name) return angles;
  }
  return std::nullopt;
}

Camera look_at(Vec3d eye, Vec3d target, Vec3d up, const Lens& lens) {
  Camera camera;
  camera.eye = eye;
  set_directions(camera, target - eye, up);
  const double distance = length(target - eye);
  camera.orthographic = lens.orthographic;
  camera.half_height = half_height_at_one(lens) * (lens.orthographic ? distance : 1);
  camera.near_distance = distance > 0 ? distance * 1e-3 : 1e-3;
  return camera;
}

Camera frame_points(std::span<const Vec3d> points, const ViewAngles& angles, double aspect, const Lens& lens,
                    Vec3d up) {
  constexpr double kMargin = 1.05;
  Camera camera = turned(angles, up);
  camera.orthographic = lens.orthographic;
  const double slope = half_height_at_one(lens);
  const double used = lens.orthographic ? 0 : slope / kMargin;  // parallel rays have no slope
  Box3d box;
  for (const Vec3d& p : points) {
    if (is_finite(p)) box.add(p);
  }
  const Vec3d origin = box.empty() ? Vec3d{} : box.center();
  Reach across, along;
  double nearest = std::numeric_limits<double>::infinity(), farthest = -nearest;
  for (const Vec3d& point : points) {
    if (!is_finite(point)) continue;
    const Vec3d p = point - origin;
    const double depth = dot(p, camera.forward);
    across.add(dot(p, camera.right), depth, used * aspect);
    along.add(dot(p, camera.up), depth, used);
    nearest = std::min(nearest, depth);
    farthest = std::max(farthest, depth);
  }
  if (box.empty()) {
    across.add(0, 0, 0);
    along.add(0, 0, 0);
    nearest = farthest = 0;
  }
  double distance = 0, half_height = slope;
  if (lens.orthographic) {
    half_height = std::max(along.half(), across.half() / aspect) * kMargin;
    if (!(half_height > 0)) half_height = 1;  // a point, or a line seen from its end
    distance = std::max(half_height, farthest - nearest) - nearest;
  } else {
    distance = std::max(along.half() / used, across.half() / (used * aspect));
    if (!(distance + nearest > 0)) distance = 1 - nearest;
  }
  camera.half_height = half_height;
  camera.eye = origin + camera.right * across.middle() + camera.up * along.middle() - camera.forward * distance;
  camera.near_distance = std::max((distance + farthest) * 1e-6, (distance + nearest) * 0.5);
  return camera;
}

Camera frame_bounds(const Box3d& bounds, const ViewAngles& angles, double aspect, const Lens& lens, Vec3d up) {
  std::array<Vec3d, 8> corners;
  for (std::size_t i = 0; i < 8; ++i) {
    corners[i] = {(i & 1) != 0 ? bounds.max.x : bounds.min.x, (i & 2) != 0 ? bounds.max.y : bounds.min.y,
                  (i & 4) != 0 ? bounds.max.z : bounds.min.z};
  }
  return frame_points(corners, angles, aspect, lens, up);
}

}  // namespace lodestone
