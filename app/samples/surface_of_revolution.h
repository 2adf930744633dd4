// Closed surfaces as a stack of rings between two poles, with any even number of triangles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "lodestone/base/task.h"
#include "lodestone/core/mesh.h"

namespace lodestone::app {

/// Vertices of each ring from the bottom up, and where on the profile each ring lies (0 to 1).
struct RevolutionPlan {
  std::vector<std::uint32_t> counts;  ///< at least 3 each
  std::vector<double> places;
};

/// How far around the surface is at a place, and how long the way from pole to pole: for triangles of even size.
struct RevolutionProfile {
  std::function<double(double)> around;  ///< circumference at a place in [0, 1]
  double length = 1;                     ///< from pole to pole; places are shares of it
};

/// Exactly `triangles` triangles when that is even and at least 6, else the nearest such count.
RevolutionPlan plan_rings(std::size_t triangles, const RevolutionProfile& profile);

/// Position at a place (0 to 1, bottom to top) and an angle in turns, counter-clockwise seen from above.
using RingSurface = std::function<Vec3d(double place, double turns)>;

/// Triangles = twice the sum of the counts. Closed, genus 0. O(triangles). `surface` is called from several threads.
/// What comes back from a cancelled task is not complete.
Mesh stack_rings(const RevolutionPlan& plan, const RingSurface& surface, const Task& task = {});

}  // namespace lodestone::app
