// How far one surface can be from another at most: what turns the largest distance found into a certified one.
#pragma once

#include <cstdint>
#include <span>

#include "lodestone/base/task.h"
#include "lodestone/measure/graph_bound_detail.h"
#include "lodestone/spatial/bvh.h"

namespace lodestone::measure::detail {

/// The closest point of a vertex on the other surface, without the point.
struct VertexDistance {
  double distance = 0;
  std::uint32_t triangle = kNone;  ///< of the other surface; kNone for a vertex that no triangle uses
};

/// The largest distance that was found, and where.
struct Peak {
  double distance_sq = -1;
  std::uint32_t triangle = kNone;  ///< of the first surface
  Vec3d at;
};

bool is_higher(const Peak& a, const Peak& b);

struct VertexDistances {
  std::vector<VertexDistance> of;  ///< one a position of the first surface
  Peak peak;
};

/// All vertices of `from` that a triangle uses. O(vertices log triangles).
VertexDistances vertex_distances(const spatial::Surface& from, const spatial::Bvh& to, const Task& task);

struct BoundOptions {
  double tolerance = 0.01;    ///< the search ends when the bound is at most this share above the maximum,
  double floor = 0;           ///< or at most this length above it (model units)
  std::uint64_t queries = 0;  ///< closest points that it may look up
};

struct MaximumBound {
  Peak peak;         ///< the largest distance that was found, and where: the true maximum is not smaller,
  double upper = 0;  ///< and not larger than this (up to rounding in double precision)
};

/// The interval that holds max over p in `from` of distance(p, `to`). `known` is the largest distance known so far,
/// `at_vertices` has one entry a position of `from`, `neighbors` are those of `to`. Branch and bound over the triangles
/// of `from`; same figures for any thread count. O(triangles + queries · log triangles of `to`).
MaximumBound bound_maximum(const spatial::Surface& from, const spatial::Bvh& to, const Neighbors& neighbors,
                           std::span<const VertexDistance> at_vertices, const Peak& known, const BoundOptions& options,
                           const Task& task);

}  // namespace lodestone::measure::detail
