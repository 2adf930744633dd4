// A certified bound: how far the first surface is from the second at most.
//
// Problem: the largest distance that samples find is smaller than the true maximum. Method: branch and bound over the
// triangles of the first surface. A piece of a triangle is done with once its bound is within the tolerance of the
// largest distance found; of all others the one with the highest bound is halved. docs/measuring.md, "How", point 4.
// 1. Search::add(), run(): a chunk's triangles, then pieces from a heap, highest bound first, until none is above the
//    limit or the queries are used up.
// 2. halve(): cuts the longest side, where possible at the place between two closest triangles, and asks for the
//    closest point there, which may raise the largest distance found.
// 3. bound_of(): the cheapest bound that suffices. The distance to one triangle is a convex function, so over a piece
//    whose corners have the same closest triangle it is largest at a corner. Else: the largest at a corner plus the
//    farthest that a point can be from all corners; the surface above as a graph (graph_bound.cpp); the distance to any
//    one triangle (bound_by_one()); the piece cut where two or three triangles are equally far, each part bounded by
//    its own triangle (bound_of_two(), bound_of_three(), between()).
// 4. bound_maximum(): chunks of a fixed size, each with its share of the queries.
// Invariants: the true maximum lies between `peak` and `upper`, up to rounding in double precision. Chunks know nothing
// of each other: the same figures for any thread count.
// Cost: O(triangles), plus one closest-point query a halving; most triangles need none.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "lodestone/base/parallel.h"
#include "lodestone/math/triangle.h"
#include "lodestone/measure/maximum_bound_detail.h"

namespace lodestone::measure::detail {

namespace {

constexpr std::size_t kChunk = 4096;  // triangles that are searched together, by one thread
constexpr double kLeast = 0.15;       // of a side: where a cut may lie
constexpr int kSteps = 6;             // towards the point between two triangles

struct Corner {
  Vec3d at;
  double distance;
  std::uint32_t triangle;  // closest one of the other surface
};

struct Piece {
  std::array<Corner, 3> corners;
  std::uint32_t triangle;  // of the first surface
  double upper;            // the distance is nowhere larger on it
};

bool is_lower(const Piece& a, const Piece& b) { return a.upper < b.upper; }

class Search {
 public:
  Search(const spatial::Surface& from, const spatial::Bvh& to, const Neighbors& neighbors,
         std::span<const VertexDistance> at_vertices, const Peak& known, const BoundOptions& options)
      : from_(from),
        to_(to),
        graph_(to.surface(), neighbors),
        at_vertices_(at_vertices),
        options_(options),
        best_(known),
        max_(std::sqrt(known.distance_sq)) {}

  void add(std::uint32_t triangle) {
    const auto& v = from_.triangles[triangle];
    Piece piece;
    for (std::size_t i = 0; i < 3; ++i) {
      piece.corners[i] = {from_.positions[v[i]], at_vertices_[v[i]].distance, at_vertices_[v[i]].triangle};
    }
    piece.triangle = triangle;
    piece.upper = std::numeric_limits<double>::infinity();
    keep_if_needed(piece);
  }

  MaximumBound run(std::uint64_t queries, const Task& task) {
    for (; !heap_.empty() && heap_.front().upper > limit(); --queries) {
      // More pieces than queries: the goal is out of reach. Only some queries go on looking for a larger maximum.
      if (heap_.size() > queries) queries -= queries / 64;
      if (queries == 0 || task.cancelled()) return {best_, heap_.front().upper};
      std::pop_heap(heap_.begin(), heap_.end(), is_lower);
      const Piece piece = heap_.back();
      heap_.pop_back();
      halve(piece);
    }
    // What was put aside was below the limit of its time, which only rises.
    return {best_, std::max(max_, aside_)};
  }

 private:
  double limit() const { return std::max(max_ * (1 + options_.tolerance), max_ + options_.floor); }

  double distance_to(Vec3d p, std::uint32_t triangle) const {
    const auto [a, b, c] = to_.surface().corners(triangle);
    return std::sqrt(closest_point(p, a, b, c).distance_sq);
  }

  void keep_if_needed(Piece& piece) {
    piece.upper = std::min(piece.upper, bound_of(piece));
    if (piece.upper <= limit()) {
      aside_ = std::max(aside_, piece.upper);
      return;
    }
    heap_.push_back(piece);
    std::push_heap(heap_.begin(), heap_.end(), is_lower);
  }

  void halve(const Piece& piece) {
    const auto& c = piece.corners;
    std::size_t longest = 0;
    double length = -1;
    for (std::size_t i = 0; i < 3; ++i) {
      const double side = length_sq(c[(i + 1) % 3].at - c[i].at);
      if (side > length) {
        length = side;
        longest = i;
      }
    }
    const Corner &a = c[longest], &b = c[(longest + 1) % 3], &opposite = c[(longest + 2) % 3];
    // Where two closest triangles meet, so that the halves have fewer of them; in the middle where that makes a sliver.
    Vec3d middle = (a.at + b.at) * 0.5;
    if (a.triangle != b.triangle) {
      const Vec3d m = between(a, b).at;
      const double share_sq = length_sq(m - a.at) / length;
      if (share_sq > kLeast * kLeast && share_sq < (1 - kLeast) * (1 - kLeast)) middle = m;
    }
    const spatial::Nearest nearest = to_.closest(middle, a.triangle);
    if (nearest.distance_sq > best_.distance_sq) {
      best_ = {nearest.distance_sq, piece.triangle, middle};
      max_ = std::sqrt(nearest.distance_sq);
    }
    const Corner m{middle, std::sqrt(nearest.distance_sq), nearest.triangle};
    Piece half{{a, m, opposite}, piece.triangle, piece.upper};
    keep_if_needed(half);
    half = {{m, b, opposite}, piece.triangle, piece.upper};
    keep_if_needed(half);
  }

  double bound_of(const Piece& piece) {
    const auto& [a, b, c] = piece.corners;
    const double highest = std::max({a.distance, b.distance, c.distance});
    if (a.triangle == b.triangle && b.triangle == c.triangle) return highest;
    // No point of a triangle is farther from all its corners than the longest side over the root of 3.
    const double side = std::sqrt(std::max({length_sq(b.at - a.at), length_sq(c.at - b.at), length_sq(a.at - c.at)}));
    const double reach = highest + side * 0.57735026918962584;
    if (reach <= limit()) return reach;
    const std::uint32_t start[3] = {a.triangle, b.triangle, c.triangle};
    const double graph = graph_({a.at, b.at, c.at}, start, limit());
    if (graph <= limit()) return graph;
    const double by_one = bound_by_one(a, b, c);
    if (by_one <= limit()) return by_one;
    if (a.triangle == b.triangle) return std::min({reach, by_one, bound_of_two(a, b, c)});
    if (b.triangle == c.triangle) return std::min({reach, by_one, bound_of_two(b, c, a)});
    if (c.triangle == a.triangle) return std::min({reach, by_one, bound_of_two(c, a, b)});
    return std::min({reach, by_one, bound_of_three(a, b, c)});
  }

  // By the distance to one triangle of the other surface, whichever serves best.
  double bound_by_one(const Corner& a, const Corner& b, const Corner& c) const {
    const auto by = [&](std::uint32_t t, const Corner& x, const Corner& y, const Corner& z) {
      const double first = y.triangle == t ? y.distance : distance_to(y.at, t);
      return std::max({x.distance, first, z.triangle == t ? z.distance : distance_to(z.at, t)});
    };
    return std::min({by(a.triangle, a, b, c), by(b.triangle, b, c, a), by(c.triangle, c, a, b)});
  }

  // a and b share their closest triangle, c has another.
  double bound_of_two(const Corner& a, const Corner& b, const Corner& c) const {
    return std::max({a.distance, b.distance, c.distance, between(a, c).distance, between(b, c).distance});
  }

  double bound_of_three(const Corner& a, const Corner& b, const Corner& c) const {
    const Middle ab = between(a, b), bc = between(b, c), ca = between(c, a);
    const double sides = std::max({a.distance, b.distance, c.distance, ab.distance, bc.distance, ca.distance});
    // Towards where the three triangles meet, in the plane of the piece.
    const Vec3d normal = normalized(scaled_normal(a.at, b.at, c.at));
    Vec3d center = (ab.at + bc.at + ca.at) / 3.0;
    double at_center = std::numeric_limits<double>::infinity();
    for (int i = 0; i < kSteps && at_center > std::max(sides, limit()); ++i) {
      Vec3d sum;
      double largest_sq = 0;
      for (const Corner* corner : {&a, &b, &c}) {
        const auto [p, q, r] = to_.surface().corners(corner->triangle);
        const ClosestPoint closest = closest_point(center, p, q, r);
        largest_sq = std::max(largest_sq, closest.distance_sq);
        sum += closest.point;
      }
      at_center = std::min(at_center, std::sqrt(largest_sq));
      center = sum / 3.0;
      center -= normal * dot(normal, center - a.at);
    }
    return std::max(sides, at_center);
  }

  struct Middle {
    Vec3d at;
    double distance;  // the larger of both: a bound wherever the point lies
  };

  // The point of the side from a to b where both closest triangles are about equally far (regula falsi, Illinois).
  Middle between(const Corner& a, const Corner& b) const {
    double low = 0, high = 1;
    double at_low = a.distance - distance_to(a.at, b.triangle);   // not positive
    double at_high = distance_to(b.at, a.triangle) - b.distance;  // not negative
    Middle best{a.at, std::max(a.distance, a.distance - at_low)};
    if (const double other = b.distance + at_high; other < best.distance) best = {b.at, other};
    for (int i = 0; i < kSteps && best.distance > limit() && at_high - at_low > 0; ++i) {
      const double s = low + (high - low) * (-at_low / (at_high - at_low));
      const Vec3d p = a.at + (b.at - a.at) * s;
      const double to_a = distance_to(p, a.triangle), to_b = distance_to(p, b.triangle), difference = to_a - to_b;
      if (const double larger = std::max(to_a, to_b); larger < best.distance) best = {p, larger};
      if (std::abs(difference) <= 1e-3 * to_a) break;
      if (difference > 0) {
        high = s;
        at_high = difference;
        at_low /= 2;
      } else {
        low = s;
        at_low = difference;
        at_high /= 2;
      }
    }
    return best;
  }

  const spatial::Surface& from_;
  const spatial::Bvh& to_;
  GraphBound graph_;
  std::span<const VertexDistance> at_vertices_;
  BoundOptions options_;
  Peak best_;
  double max_;        // root of best_.distance_sq
  double aside_ = 0;  // highest bound of the pieces that need no halving
  std::vector<Piece> heap_;
};

MaximumBound join(const MaximumBound& a, const MaximumBound& b) {
  return {is_higher(b.peak, a.peak) ? b.peak : a.peak, std::max(a.upper, b.upper)};
}

}  // namespace

bool is_higher(const Peak& a, const Peak& b) {
  return a.distance_sq != b.distance_sq ? a.distance_sq > b.distance_sq : a.triangle < b.triangle;
}

MaximumBound bound_maximum(const spatial::Surface& from, const spatial::Bvh& to, const Neighbors& neighbors,
                           std::span<const VertexDistance> at_vertices, const Peak& known, const BoundOptions& options,
                           const Task& task) {
  const std::size_t triangles = from.triangles.size();
  return parallel_reduce(
      triangles, kChunk, task, MaximumBound{known, std::sqrt(known.distance_sq)},
      [&](std::size_t begin, std::size_t end) {
        Search search(from, to, neighbors, at_vertices, known, options);
        for (std::size_t t = begin; t < end; ++t) search.add(static_cast<std::uint32_t>(t));
        const double share = static_cast<double>(end - begin) / static_cast<double>(triangles);
        MaximumBound found = search.run(static_cast<std::uint64_t>(share * static_cast<double>(options.queries)), task);
        task.advance(share);
        return found;
      },
      join);
}

}  // namespace lodestone::measure::detail
