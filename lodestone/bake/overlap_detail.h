// Whether triangles laid out in the plane overlap.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "lodestone/bake/plane_detail.h"

namespace lodestone::bake::detail {

/// The plane cut into square cells that know what reaches into them.
class Cells {
 public:
  /// For things with these boxes; the cells are of about their size.
  explicit Cells(const std::vector<PlaneBox>& boxes);

  /// Calls visit(index) for what was added and may meet the box, some more than once, until it returns false; then
  /// returns false, too.
  template <class Visit>
  bool visit(const PlaneBox& box, Visit&& visit) const {
    const Range r = range(box);
    for (std::size_t y = r.y0; y <= r.y1; ++y) {
      for (std::size_t x = r.x0; x <= r.x1; ++x) {
        for (std::uint32_t i = head_[y * columns_ + x]; i != kEnd; i = entries_[i].next) {
          if (!visit(entries_[i].index)) return false;
        }
      }
    }
    return true;
  }
  void add(const PlaneBox& box, std::uint32_t index);

 private:
  static constexpr std::uint32_t kEnd = 0xFFFFFFFF;
  struct Range {
    std::size_t x0, y0, x1, y1;
  };
  struct Entry {
    std::uint32_t index, next;
  };
  Range range(const PlaneBox& box) const;
  void set_cell(double cell, Vec2d size);

  Vec2d origin_;
  double cell_ = 1;
  std::size_t columns_ = 1, rows_ = 1;
  std::vector<std::uint32_t> head_;
  std::vector<Entry> entries_;
};

/// True if they share more than sides and corners, beyond rounding.
bool overlap(const FlatTriangle& a, const FlatTriangle& b);

/// A side at the rim of a chart, with the triangle on its left.
struct RimSide {
  Vec2d from, to;
  std::uint32_t from_vertex, to_vertex;
};

/// True if the rim shows that the triangles inside, all counter-clockwise and connected, don't overlap: loops that
/// neither cross nor touch, one of them around all others. Then it winds at most once around any point, which is how
/// many triangles cover that. False where that can't be told. O(n) for sides of a length.
bool rim_is_simple(const std::vector<RimSide>& rim);

}  // namespace lodestone::bake::detail
