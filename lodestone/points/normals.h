// Normals of points that have none, or whose normals don't say which side is outside.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/point_cloud.h"

namespace lodestone::points {

struct NormalOptions {
  std::uint32_t neighbors = 16;        ///< that the plane of a point is fitted to, 3 to 64
  std::uint32_t graph_neighbors = 10;  ///< that orientation spreads to, 1 to 64
};

struct Normals {
  std::vector<Vec3f> normals;  ///< unit vectors; (0, 0, 0) where all neighbours lie in one place
  std::uint64_t unknown = 0;   ///< how many are (0, 0, 0)
  std::uint64_t pieces = 0;    ///< of the neighbours' graph, each oriented by itself; 0 when nothing was oriented
};

/// The direction in which the nearest points spread least (principal components), oriented as by orient_normals().
/// O(n log n), memory about 200 bytes a point. Same bytes for any thread count. Errors: empty (no point), bad_argument
/// (numbers of neighbours out of range; those of validate()), cancelled.
Result<Normals> estimate_normals(const PointCloud& cloud, const NormalOptions& options = {}, const Task& task = {});

/// Turns some of the cloud's normals around so that neighbours agree and the outermost look outward: along a minimum
/// spanning tree of the neighbours' graph, whose edges cost 1 - |n1 . n2| (H. Hoppe, T. DeRose, T. Duchamp, J. McDonald
/// and W. Stuetzle, Surface Reconstruction from Unorganized Points, SIGGRAPH 1992). Each piece of the graph begins at
/// that of its six extreme points whose normal lies nearest to the axis. Thin parts whose two sides are nearer than the
/// points to each other may come out wrong. Lengths are kept. Cost and errors as above; bad_argument also where there
/// is not one normal a point.
Result<Normals> orient_normals(const PointCloud& cloud, const NormalOptions& options = {}, const Task& task = {});

/// Of 26 directions all around, the share in which the farthest point's normal looks that way (0 to 1; 1 without any
/// known normal): near 0 for normals that look inward, as those that were turned to a scanner inside do. O(n).
double outward_share(const PointCloud& cloud);

}  // namespace lodestone::points
