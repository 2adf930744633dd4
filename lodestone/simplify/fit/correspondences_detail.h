// Correspondences: pairs of points that pull a level to its original, in both directions.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "lodestone/simplify/fit/target.h"
#include "lodestone/simplify/fit/triangle_error.h"

namespace lodestone::simplify::detail {

/// A point of the level and its partner on the original: either the closest point of the level to a point of the
/// original, or a point of the level and the closest point of the original.
struct Correspondence {
  std::uint32_t triangle = 0;   ///< of the level
  float second = 0, third = 0;  ///< weights of the level's second and third corner
  float weight = 0;             ///< share of its side's area that it stands for
  Vec3d partner;                ///< on the original

  Vec3d on(const std::array<Vec3d, 3>& corners) const {
    const double s = static_cast<double>(second), t = static_cast<double>(third);
    return corners[0] * (1 - s - t) + corners[1] * s + corners[2] * t;
  }
};

/// Weights of the second and third corner: points of a level that stand for a fourth of a triangle each, one near each
/// corner, so that few of them tell much of its shape. Their sum integrates linear functions exactly.
inline constexpr float kInner[3][2] = {{1.0F / 6, 1.0F / 6}, {2.0F / 3, 1.0F / 6}, {1.0F / 6, 2.0F / 3}};

struct Correspondences {
  std::vector<Correspondence> list;  ///< by triangle; the last ones of each are the points of the level
  std::vector<std::uint32_t> first;  ///< of each triangle, and the end
  /// Mean of both directions' area-weighted mean distances, and the largest distance.
  double mean = 0, max = 0;
  double energy = 0;                  ///< sum of weighted squares over both directions
  std::vector<TriangleError> worst;   ///< of each triangle
  std::vector<TriangleError> corner;  ///< the distance of each vertex of the level
  std::vector<TriangleError>
      close;  ///< the same of the triangles that have been looked at closely; a distance of 0 = not so
};

using TrianglePair = std::array<std::uint32_t, 2>;

/// After pairs of triangles have changed within their common outline: correspondences to a pair go to the nearer of
/// both. Vertices, lattices and the maximum are not looked at again; find_correspondences() does that.
/// O(correspondences + pairs * log triangles).
void update_correspondences(const FitTarget& target, const spatial::Surface& level,
                            const std::vector<TrianglePair>& changed, Correspondences& correspondences,
                            const Task& task);

/// A level as it was, and its correspondences then.
struct Known {
  spatial::Surface level;
  Correspondences correspondences;
};

/// Finds all partners. With what is known of a level that has triangles in common with this one, only partners that the
/// other triangles could change are looked for; the correspondences are the same. What probe_worst_errors() found on
/// the common triangles is taken over. O((points + triangles) log triangles).
Correspondences find_correspondences(const FitTarget& target, const spatial::Surface& level, const Task& task,
                                     const Known* known = nullptr);

/// Looks closely at triangles whose worst is above `share` of the maximum, if that was not done before: many points on
/// each, and on its sides. Raises `worst` and `max` where more is found.
void probe_worst_errors(const FitTarget& target, const spatial::Surface& level, double share,
                        Correspondences& correspondences, const Task& task);

}  // namespace lodestone::simplify::detail
