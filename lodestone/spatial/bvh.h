// Bounding-volume tree over a surface's triangles, for closest-point queries.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "lodestone/base/task.h"
#include "lodestone/spatial/surface.h"

namespace lodestone::spatial {

/// The nearest triangle, the nearest point on it, and how far it is.
struct Nearest {
  std::uint32_t triangle = kNone;
  Vec3d point;
  double distance_sq = std::numeric_limits<double>::infinity();
};

/// A packed tree: four children a node, the surface's Hilbert order cut into fours level by level, so nothing needs a
/// pointer. Boxes are floats rounded outward, triangles are tested in double: the answer is exact in double precision.
/// Build O(n), memory about 32 bytes a triangle. Where many triangles are long and thin, each of these has several
/// boxes (thin_pieces_detail.h): O(n log n), and up to five times the memory and 36 MB. The surface must outlive it.
class Bvh {
 public:
  explicit Bvh(const Surface& surface, const Task& task = {});

  /// The closest point to p. `hint` is a triangle that is probably near (any, or kNone): a good one makes it several
  /// times faster and never changes the distance. Of equally near triangles that the search meets, the one with the
  /// lowest number.
  Nearest closest(Vec3d p, std::uint32_t hint = kNone) const;

  /// As closest(), of the triangles alone whose normal is within 90 degrees of `normal` and that are no farther
  /// than `within`; triangle = kNone where there is none.
  Nearest closest_facing(Vec3d p, Vec3d normal, double within) const;

  /// All triangles not farther than `within`, once each, appended to `found`. Their order depends on the surface alone.
  void all_within(Vec3d p, double within, std::vector<Nearest>& found) const;

  /// The triangles whose boxes reach into `box`, into `found`: all that a point of it could touch. False, with `found`
  /// incomplete, when there are more boxes than `most`; each triangle once, otherwise.
  bool triangles_in(const Box3d& box, std::size_t most, std::vector<std::uint32_t>& found) const;

  const Surface& surface() const { return surface_; }

 private:
  // Boxes of four children, one array a side, so that four distances are computed at once.
  struct alignas(16) Node {
    float min[3][4], max[3][4];
  };
  Nearest test(Vec3d p, std::uint32_t triangle) const;
  std::uint32_t triangle_of(std::uint32_t leaf) const { return leaf_triangle_.empty() ? leaf : leaf_triangle_[leaf]; }
  // box_of(child) for each child of this level's nodes; the nodes of the level below are filled.
  template <class BoxOf>
  void fill_level(std::size_t level, std::size_t children, const Task& task, BoxOf box_of);
  // Visits triangles, near ones first, and calls take(triangle) for each whose box is within limit_sq. `take` may lower
  // the limit.
  template <class Take>
  void search(Vec3d p, const double& limit_sq, Take&& take) const;

  const Surface& surface_;
  std::vector<std::uint32_t> leaf_triangle_;  // of each leaf, where triangles have several; empty = its own number
  Vec3d center_;                              // boxes are relative to it,
  double scale_ = 1;                        // and scaled so that they lie in [-1, 1]: no overflow, no subnormal numbers
  std::vector<Node> nodes_;                 // level 0 (children are triangles) first, the root last
  std::vector<std::uint32_t> level_first_;  // first node of each level, and the end
};

}  // namespace lodestone::spatial
