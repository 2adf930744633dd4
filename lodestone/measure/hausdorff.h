// Certified Hausdorff distance between two surfaces.
#pragma once

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/model.h"

namespace lodestone::measure {

/// max over p on the first surface of the distance from p to the other: it lies in [lower, upper].
struct HausdorffInterval {
  double lower = 0, upper = 0;  ///< model units
  Vec3d lower_at;               ///< a point of the first surface that is `lower` away from the other
};

struct Hausdorff {
  HausdorffInterval forward;    ///< from A to B
  HausdorffInterval backward;   ///< from B to A
  double lower = 0, upper = 0;  ///< of the two-sided distance, the larger of both
};

/// The one- and two-sided Hausdorff distances of what two models draw (default scene, world space, all instances, bind
/// pose), as intervals no wider than `tolerance` (model units), by branch and bound over all triangles; bounds hold up
/// to rounding in double precision. Same figures for any thread count. O((vertices + pieces) log triangles); surfaces
/// that lie close to each other need few pieces, those whose triangles cross or double need about area / tolerance^2.
/// Errors: bad_argument (tolerance not above 1e-9 of the larger diagonal; those of validate()), empty, cancelled.
Result<Hausdorff> hausdorff(const Model& a, const Model& b, double tolerance, Task task = {});

}  // namespace lodestone::measure
