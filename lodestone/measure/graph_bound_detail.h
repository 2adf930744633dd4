// A bound for the distance of a triangle from a surface that lies over it like a graph.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "lodestone/spatial/neighbors.h"

namespace lodestone::measure::detail {

using Neighbors = std::vector<std::array<std::uint32_t, 3>>;

/// Looks along the normal of a triangle of one surface at the patch of the other that lies over it.
class GraphBound {
 public:
  GraphBound(const spatial::Surface& to, const Neighbors& neighbors) : to_(to), neighbors_(neighbors) {}

  /// No point of the triangle is farther from the surface than this; infinite where the patch around `start` (triangles
  /// of `to`, any) is no graph over it: where it turns away, ends, branches, or has more than some forty triangles.
  /// Once the bound is above `enough` any larger figure may be given.
  double operator()(const std::array<Vec3d, 3>& corners, std::span<const std::uint32_t> start, double enough);

 private:
  struct Flat {
    double x, y, height;
  };
  bool visit(std::uint32_t triangle);

  const spatial::Surface& to_;
  const Neighbors& neighbors_;
  // Of the triangle in question: its frame, and its sides as lines whose inner side is positive.
  Vec3d origin_, x_, y_, up_;
  struct Line {
    double a, b, c;
  };
  std::array<Flat, 3> piece_;
  std::array<Line, 3> lines_;
  double facing_ = 0;   // projected area of a triangle of the patch, for its sign; 0: none lies over the piece so far
  double highest_ = 0;  // largest height so far, either way
  std::vector<std::uint32_t> patch_;
};

}  // namespace lodestone::measure::detail
