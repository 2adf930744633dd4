// Closest points for many points at once.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "lodestone/spatial/bvh.h"

namespace lodestone::spatial {

/// Asks a tree for groups of eight points that are near each other: what lies near the group's middle is looked up
/// once, tested in single precision against four points at a time, and the few that may be nearest again in double. So
/// answers are as exact as Bvh::closest's. Groups that are spread wider than the triangles are asked for one by one.
/// One object a thread.
class ClosestBatch {
 public:
  explicit ClosestBatch(const Bvh& tree) : tree_(tree) {}

  /// closest[i] belongs to points[i]; the same number of both. Some thousands at a time serve best.
  void find(std::span<const Vec3d> points, std::span<Nearest> closest);

 private:
  static constexpr std::size_t kGroup = 8;
  static constexpr std::size_t kMostTriangles = 96;
  using Group = std::span<const std::uint32_t>;  // numbers of points
  void sort(std::span<const Vec3d> points);
  bool find_group(std::span<const Vec3d> points, Group group, std::span<Nearest> closest);

  float test_near(const float (&coordinates)[3][kGroup], Vec3d middle, float reach);

  const Bvh& tree_;
  std::uint32_t hint_ = kNone;
  double within_ = -1;  // how far to look, from the group before; negative: not known
  std::vector<std::uint32_t> keys_, half_sorted_, order_;
  std::vector<std::uint32_t> near_;
  std::array<std::array<float, kGroup>, kMostTriangles> lowest_{};  // distance at least, by triangle of near_
  std::array<float, kGroup> highest_{};                             // to the closest at most
};

}  // namespace lodestone::spatial
