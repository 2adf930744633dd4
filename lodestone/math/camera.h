// Cameras: where the eye is, where it looks, and how wide.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "lodestone/math/box.h"
#include "lodestone/math/vec.h"

namespace lodestone {

/// Right-handed; `right`, `up` and `forward` are unit vectors at right angles. Lengths in model units.
struct Camera {
  Vec3d eye;
  Vec3d right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, -1};
  bool orthographic = false;
  /// Half the height of what is seen: at distance 1 from the eye (the tangent of half the vertical field of view), or,
  /// orthographic, at any distance. The width follows from the picture's shape.
  double half_height = 0.41421356237309503;
  double near_distance = 1e-3;  ///< what is nearer to the eye, along `forward`, is cut off; above 0
};

/// How a camera projects.
struct Lens {
  bool orthographic = false;
  double fov_degrees = 45;  ///< vertical field of view, in (0, 180); orthographic: that of the view it replaces
};

/// From where to look at a model. At 0, 0 from its front: with y up (glTF) the eye is on +z, with z up on -y.
/// `azimuth` turns it to the right (90: from +x), `elevation` lifts it (90: from above, the front below).
struct ViewAngles {
  double azimuth_degrees = 0, elevation_degrees = 0;
};

/// front, back, left, right (of someone who stands before it: right is +x), top, bottom, iso (azimuth 45, elevation
/// 35.26). Nothing for another name.
std::optional<ViewAngles> named_view(std::string_view name);

/// Looks from `eye` at `target`. An `up` along the line of sight (or zero) is replaced by another axis. Orthographic:
/// as large at the target as perspective would show it.
Camera look_at(Vec3d eye, Vec3d target, Vec3d up = {0, 1, 0}, const Lens& lens = {});

/// From as near as lets all `points` be seen, in the middle, with a margin of a twentieth. `aspect`: the picture's
/// width over its height. Points that are not finite don't count; without any it looks at the origin. O(points).
Camera frame_points(std::span<const Vec3d> points, const ViewAngles& angles, double aspect, const Lens& lens = {},
                    Vec3d up = {0, 1, 0});

/// The same for the corners of a box.
Camera frame_bounds(const Box3d& bounds, const ViewAngles& angles, double aspect, const Lens& lens = {},
                    Vec3d up = {0, 1, 0});

}  // namespace lodestone
