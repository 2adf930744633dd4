// Edges turned over where that brings the level nearer to its original (edge swaps of [hoppe-1993]).
//
// flip_edges():
// 1. gain_of() tells for each edge between two triangles (quad_of()) by how much turning it lowers the squared
//    distances of both triangles' correspondences. An edge has no gain
//    - if they fall by less than two per cent;
//    - if the new triangles have a bad shape (shape_allows()): they face away from the old ones, fold onto a neighbour,
//      or have a much smaller angle;
//    - if a point of the new edge or triangles is farther from the original than the worst point was.
// 2. Edges are turned (turn()), the largest gain first. Left out are edges of triangles that have changed or lie next
//    to one that has, and edges in whose place there would be one that exists already (joined()).
//
// Triangles keep their numbers. Fixed sides (no_flip), and edges whose four vertices are all no_move, are not turned.
// Gains are found in parallel, edges turned in one order: the same bytes for any number of threads.
// O(triangles log triangles of the original).
#include <algorithm>
#include <array>
#include <cmath>

#include "lodestone/base/parallel.h"
#include "lodestone/math/triangle.h"
#include "lodestone/simplify/fit/flip_detail.h"
#include "lodestone/simplify/fit/solve_detail.h"
#include "lodestone/spatial/neighbors.h"

namespace lodestone::simplify::detail {

namespace {

using Corners = std::array<Vec3d, 3>;
using Neighbors = std::vector<std::array<std::uint32_t, 3>>;

constexpr double kWorth = 0.98;   // of the energy before
constexpr double kFacing = 0.5;   // cosine between new faces and the mean of the old ones
constexpr double kThinner = 0.5;  // of the smallest angle's sine before, where that is small
constexpr double kThin = 0.17;    // sine: 10 degrees
constexpr double kFold = -0.5;    // cosine between a new face and a neighbour, if both old faces were above it
constexpr std::size_t kLevelPoints = std::size(kInner);  // the last ones of each triangle are points of the level

// The quadrilateral around an edge: first triangle (a, b, c), second (b, a, d).
struct Quad {
  std::uint32_t first, second;  // triangles
  std::uint32_t a, b, c, d;     // vertices
  std::size_t side1, side2;     // of the edge in both
};

Quad quad_of(const spatial::Surface& level, std::uint32_t first, std::size_t side, std::uint32_t second) {
  const Triangle &t = level.triangles[first], &u = level.triangles[second];
  Quad q{first, second, t[side], t[(side + 1) % 3], t[(side + 2) % 3], 0, side, 0};
  for (std::size_t k = 0; k < 3; ++k) {
    if (u[k] != q.a && u[k] != q.b) {
      q.d = u[k];
      q.side2 = (k + 1) % 3;  // the side that begins at the corner after d
    }
  }
  return q;
}

double smallest_sine(const Corners& c) {
  const double twice_area = length(scaled_normal(c[0], c[1], c[2]));
  double longest = 0, middle = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double side = length(c[(k + 1) % 3] - c[k]);
    middle = side > longest ? longest : std::max(middle, side);
    longest = std::max(longest, side);
  }
  return longest * middle > 0 ? twice_area / (longest * middle) : 0;
}

bool shape_allows(const spatial::Surface& level, const Neighbors& neighbors, const Quad& q, const Corners& old1,
                  const Corners& old2, const Corners& new1, const Corners& new2) {
  const Vec3d n1 = scaled_normal(old1[0], old1[1], old1[2]), n2 = scaled_normal(old2[0], old2[1], old2[2]);
  const Vec3d mean = n1 + n2;
  const Vec3d m1 = scaled_normal(new1[0], new1[1], new1[2]), m2 = scaled_normal(new2[0], new2[1], new2[2]);
  for (const Vec3d& m : {m1, m2}) {
    if (!(dot(m, mean) > kFacing * length(m) * length(mean))) return false;
  }
  const double before = std::min(smallest_sine(old1), smallest_sine(old2));
  const double after = std::min(smallest_sine(new1), smallest_sine(new2));
  if (after < kThin && after < kThinner * before) return false;
  // Neighbours across the four outer sides.
  for (const std::uint32_t t : {q.first, q.second}) {
    for (const std::uint32_t other : neighbors[t]) {
      if (other == kNone || other == q.first || other == q.second) continue;
      const auto [x, y, z] = level.corners(other);
      const Vec3d n = scaled_normal(x, y, z);
      const auto folds = [&](const Vec3d& m) { return dot(m, n) < kFold * length(m) * length(n); };
      if ((folds(m1) || folds(m2)) && !folds(n1) && !folds(n2)) return false;
    }
  }
  return true;
}

double distance_sq(const FitTarget& target, Vec3d p, std::uint32_t& hint) {
  const spatial::Nearest near = target.tree().closest(p, hint);
  hint = near.triangle;
  return near.distance_sq;
}

// How much the energy falls by turning the edge; 0 where it must not be.
double gain_of(const FitTarget& target, const Correspondences& correspondences, const spatial::Surface& level,
               const Neighbors& neighbors, const Quad& q, double area) {
  const Corners old1 = level.corners(q.first), old2 = level.corners(q.second);
  const auto& p = level.positions;
  const Corners new1{p[q.a], p[q.d], p[q.c]}, new2{p[q.d], p[q.b], p[q.c]};
  double before = 0, points_before = 0, points_after = 0;
  for (const auto& [t, corners] : {std::pair{q.first, old1}, std::pair{q.second, old2}}) {
    for (std::uint32_t i = correspondences.first[t]; i < correspondences.first[t + 1]; ++i) {
      const Correspondence& correspondence = correspondences.list[i];
      const double energy =
          static_cast<double>(correspondence.weight) * length_sq(correspondence.partner - correspondence.on(corners));
      before += energy;
      if (i + kLevelPoints >= correspondences.first[t + 1]) continue;
      points_before += energy;
      const double d = std::min(closest_point(correspondence.partner, new1[0], new1[1], new1[2]).distance_sq,
                                closest_point(correspondence.partner, new2[0], new2[1], new2[2]).distance_sq);
      points_after += static_cast<double>(correspondence.weight) * d;
    }
  }
  if (!(points_after < points_before) || !(points_after < kWorth * before)) return 0;
  if (!shape_allows(level, neighbors, q, old1, old2, new1, new2)) return 0;
  const double worst =
      static_cast<double>(std::max(correspondences.worst[q.first].distance, correspondences.worst[q.second].distance));
  const double limit_sq = worst * worst;
  double after = points_after;
  std::uint32_t hint = kNone;
  for (const double share : {0.25, 0.5, 0.75}) {
    if (distance_sq(target, lerp(p[q.c], p[q.d], share), hint) > limit_sq) return 0;
  }
  for (const Corners& corners : {new1, new2}) {
    const double weight = length(scaled_normal(corners[0], corners[1], corners[2])) / 2 / area / kLevelPoints;
    for (const auto& w : kInner) {
      Correspondence correspondence;
      correspondence.second = w[0];
      correspondence.third = w[1];
      const double d_sq = distance_sq(target, correspondence.on(corners), hint);
      if (d_sq > limit_sq) return 0;
      after += weight * d_sq;
    }
  }
  return after < kWorth * before ? before - after : 0;
}

bool joined(const spatial::Surface& level, const CornersAt& around, std::uint32_t v, std::uint32_t w) {
  for (std::uint32_t i = around.first[v]; i < around.first[v + 1]; ++i) {
    for (const std::uint32_t other : level.triangles[around.list[i] / 3]) {
      if (other == w) return true;
    }
  }
  return false;
}

void turn(const Quad& q, std::vector<Triangle>& triangles) {
  const Triangle t = triangles[q.first], u = triangles[q.second];
  const std::uint32_t a = t[q.side1], b = t[(q.side1 + 1) % 3], c = t[(q.side1 + 2) % 3], d = u[(q.side2 + 2) % 3];
  triangles[q.first] = {a, d, c};
  triangles[q.second] = {d, b, c};
}

}  // namespace

std::vector<TrianglePair> flip_edges(const FitTarget& target, const Correspondences& correspondences,
                                     const NoFlipEdges& no_flip, std::span<const std::uint8_t> no_move,
                                     spatial::Surface& level, std::vector<Triangle>& wedges, const Task& task) {
  const Neighbors neighbors = spatial::triangle_neighbors(level);
  const CornersAt around = corners_at(level);
  double area = 0;
  for (std::size_t t = 0; t < level.triangles.size(); ++t) {
    const auto [a, b, c] = level.corners(t);
    area += length(scaled_normal(a, b, c)) / 2;
  }
  if (!(area > 0)) return {};
  std::vector<std::array<float, 3>> gains(level.triangles.size());
  parallel_for(level.triangles.size(), 256, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t t = begin; t < end; ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t other = neighbors[t][k];
        if (other == kNone || other < t) continue;
        const Quad q = quad_of(level, static_cast<std::uint32_t>(t), k, other);
        if (no_move[q.a] != 0 && no_move[q.b] != 0 && no_move[q.c] != 0 && no_move[q.d] != 0) continue;
        if (q.c == q.d || std::binary_search(no_flip.begin(), no_flip.end(), std::minmax({q.a, q.b}))) continue;
        gains[t][k] = static_cast<float>(gain_of(target, correspondences, level, neighbors, q, area));
      }
    }
  });
  struct Choice {
    float gain;
    std::uint32_t triangle;
    std::uint32_t side;
  };
  std::vector<Choice> choices;
  for (std::uint32_t t = 0; t < gains.size(); ++t) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      if (gains[t][k] > 0) choices.push_back({gains[t][k], t, k});
    }
  }
  std::stable_sort(choices.begin(), choices.end(), [](const Choice& x, const Choice& y) { return x.gain > y.gain; });
  std::vector<std::uint8_t> touched(level.triangles.size(), 0);
  std::vector<std::uint8_t> changed(level.positions.size(), 0);  // vertices with a new edge: `around` is out of date
  std::vector<TrianglePair> turned;
  for (const Choice& choice : choices) {
    const std::uint32_t first = choice.triangle, second = neighbors[first][choice.side];
    if (touched[first] != 0 || touched[second] != 0) continue;
    const Quad q = quad_of(level, first, choice.side, second);
    if ((changed[q.c] != 0 && changed[q.d] != 0) || joined(level, around, q.c, q.d)) continue;
    turn(q, level.triangles);
    turn(q, wedges);
    for (const std::uint32_t t : {first, second}) {
      touched[t] = 1;
      for (const std::uint32_t other : neighbors[t]) {
        if (other != kNone) touched[other] = 1;
      }
    }
    changed[q.c] = changed[q.d] = 1;
    turned.push_back({first, second});
  }
  return turned;
}

}  // namespace lodestone::simplify::detail
