// Ears of a flat polygon: its first triangles, and which of them are neighbours.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lodestone/io/plain/polygon.h"

namespace lodestone::io {

/// Triangles of a polygon with their neighbours. Half-edge 3t + k runs from corner k of triangle t to the next;
/// `twin` is the half-edge that runs the other way, kNoTwin on a side of the polygon.
struct PolygonTriangles {
  static constexpr std::uint32_t kNoTwin = 0xFFFFFFFF;
  std::vector<CornerTriple>& triples;
  std::vector<std::uint32_t>& twin;
};

/// Twice the signed area of a triangle, positive where it runs counter-clockwise.
inline double cross2(Vec2d a, Vec2d b, Vec2d c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

/// The corners that may lie in other corners' ears, in a tree of boxes from which they drop out.
class BluntCorners {
 public:
  /// `marked`: a corner is in.
  void build(std::span<const Vec2d> points, std::span<const std::uint8_t> marked);
  /// Of a corner that is not in.
  void add(std::uint32_t corner) { change(corner, 1); }
  /// Of one that is.
  void remove(std::uint32_t corner) { change(corner, -1); }
  /// Whether one lies in the triangle, counter-clockwise if `sign` is 1, or on its sides, but not at the place of one
  /// of its corners. Each box that is looked at costs one of the budget.
  bool any_inside(Vec2d a, Vec2d b, Vec2d c, double sign, std::uint64_t& budget) const;

 private:
  struct Box {
    Vec2d low, high;
  };
  void fill(std::size_t node, std::size_t begin, std::size_t end, std::size_t height);
  void change(std::uint32_t corner, int by);
  bool leaf_has_inside(std::size_t leaf, Vec2d a, Vec2d b, Vec2d c, double sign) const;

  std::vector<std::uint32_t> order_;  // corners, leaf by leaf; scratch of build()
  std::vector<Vec2d> points_;         // in this order
  std::vector<std::uint32_t> place_;  // of a corner in it
  std::vector<Box> boxes_;            // a heap: children of i are 2i + 1 and 2i + 2, the leaves come last
  std::vector<std::uint32_t> live_;   // of a leaf a bit a corner, of others how many are in
  std::size_t first_leaf_ = 0;
};

/// Clips ears, shortest cuts first, so that none hangs on a far corner without need.
class EarClipper {
 public:
  /// Five corners or more.
  void clip(std::span<const Vec2d> corners, PolygonTriangles out);

 private:
  struct Candidate {
    double cut_sq = 0;  // squared length of the cut
    std::uint32_t corner = 0, stamp = 0;
    bool operator<(const Candidate& o) const {  // the shortest cut on top of a heap
      return cut_sq != o.cut_sq ? cut_sq > o.cut_sq : corner > o.corner;
    }
  };

  void start();
  double area_at(std::uint32_t corner) const;
  double cut_sq(std::uint32_t corner) const;
  void mark(std::uint32_t corner);
  void mark_all();
  void offer(std::uint32_t corner);
  void offer_all();
  void charge_ring();
  bool is_ear(std::uint32_t corner);
  void clip_corner(std::uint32_t corner, PolygonTriangles& out);
  bool force(PolygonTriangles& out);
  void clip_rest(PolygonTriangles& out);
  void link(std::uint32_t half_edge, std::uint32_t from, PolygonTriangles& out);
  template <class Use>
  void for_ring(Use use) const;

  std::span<const Vec2d> flat_;
  std::vector<std::uint32_t> before_, after_;
  std::vector<std::uint32_t> owner_;    // of the side from a corner to the next: the half-edge behind it
  std::vector<std::uint8_t> is_blunt_;  // not convex; 0 for clipped ones
  std::vector<std::uint32_t> stamp_;    // of a corner's latest candidate
  std::vector<Candidate> heap_;
  BluntCorners tree_;
  bool has_tree_ = false;
  std::size_t blunt_ = 0;
  std::uint32_t left_ = 0, some_ = 0;  // corners in the ring, and one of them
  std::uint32_t turns_ = 0;
  double sign_ = 1;
  std::uint64_t budget_ = 0;
};

/// Turns diagonals until each is the better one of its two triangles' (constrained Delaunay), at most some dozen times
/// a corner.
void turn_diagonals(std::span<const Vec2d> corners, PolygonTriangles triangles);

}  // namespace lodestone::io
