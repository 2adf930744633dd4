#include <algorithm>
#include <cmath>

#include "lodestone/bake/overlap_detail.h"

namespace lodestone::bake::detail {

namespace {

constexpr double kMostEntries = 16;  // of the cells, for each thing

// True if one of a's sides has all of b on its outer side. Corners that both share are exactly on it.
bool side_separates(const FlatTriangle& a, const FlatTriangle& b) {
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec2d from = a[k], along = a[(k + 1) % 3] - from;
    bool outside = true;
    for (const Vec2d& p : b) {
      const Vec2d to = p - from;
      const double rounding = 1e-10 * (std::abs(along.x) + std::abs(along.y)) * (std::abs(to.x) + std::abs(to.y));
      outside = outside && cross(along, to) <= rounding;
    }
    if (outside) return true;
  }
  return false;
}

// Sides one behind the other on a line are told apart by it.
bool boxes_apart(const PlaneBox& a, const PlaneBox& b) {
  return a.max.x < b.min.x || b.max.x < a.min.x || a.max.y < b.min.y || b.max.y < a.min.y;
}

// True if two sides, whose boxes meet, cross or touch elsewhere than at a vertex of both.
bool meet(const RimSide& a, const RimSide& b) {
  const Vec2d along_a = a.to - a.from, along_b = b.to - b.from;
  if (a.to_vertex == b.from_vertex) return cross(along_a, along_b) == 0 && dot(along_a, along_b) < 0;
  if (b.to_vertex == a.from_vertex) return meet(b, a);
  const double b0 = cross(along_a, b.from - a.from), b1 = cross(along_a, b.to - a.from);
  const double a0 = cross(along_b, a.from - b.from), a1 = cross(along_b, a.to - b.from);
  const auto both_beside = [](double x, double y) { return (x > 0 && y > 0) || (x < 0 && y < 0); };
  return !both_beside(a0, a1) && !both_beside(b0, b1);
}

// The side that begins where each one ends; empty where one vertex has several.
std::vector<std::uint32_t> followers(const std::vector<RimSide>& rim) {
  std::vector<std::uint32_t> by_start(rim.size());
  for (std::uint32_t i = 0; i < rim.size(); ++i) by_start[i] = i;
  const auto start = [&](std::uint32_t i) { return rim[i].from_vertex; };
  std::sort(by_start.begin(), by_start.end(), [&](std::uint32_t l, std::uint32_t r) { return start(l) < start(r); });
  for (std::size_t i = 1; i < by_start.size(); ++i) {
    if (start(by_start[i]) == start(by_start[i - 1])) return {};
  }
  std::vector<std::uint32_t> next;
  std::vector<std::uint8_t> followed(rim.size(), 0);
  for (const RimSide& side : rim) {
    const auto at = std::lower_bound(by_start.begin(), by_start.end(), side.to_vertex,
                                     [&](std::uint32_t i, std::uint32_t vertex) { return start(i) < vertex; });
    if (at == by_start.end() || start(*at) != side.to_vertex || followed[*at] != 0) return {};
    followed[*at] = 1;
    next.push_back(*at);
  }
  return next;
}

// How many loops have their inside on the left.
std::size_t outer_loops(const std::vector<RimSide>& rim, const std::vector<std::uint32_t>& next) {
  std::vector<std::uint8_t> seen(rim.size(), 0);
  std::size_t count = 0;
  for (std::uint32_t first = 0; first < rim.size(); ++first) {
    if (seen[first] != 0) continue;
    double twice_area = 0;
    for (std::uint32_t i = first; seen[i] == 0; i = next[i]) {
      seen[i] = 1;
      twice_area += cross(rim[i].from - rim[first].from, rim[i].to - rim[first].from);
    }
    count += twice_area > 0 ? 1 : 0;
  }
  return count;
}

}  // namespace

Cells::Cells(const std::vector<PlaneBox>& boxes) {
  PlaneBox all;
  for (const PlaneBox& box : boxes) {
    all.add(box.min);
    all.add(box.max);
  }
  origin_ = all.min;
  const Vec2d size = all.size();
  const double longest = std::max(size.x, size.y), count = static_cast<double>(boxes.size());
  double cell = longest > 0 ? longest / std::max(1.0, std::sqrt(count) * 1.5) : 1;
  // Long things that lie aslant would fill the memory: then larger cells.
  while (cell < longest) {
    double entries = 0;
    for (const PlaneBox& box : boxes) entries += (box.size().x / cell + 1) * (box.size().y / cell + 1);
    if (entries <= kMostEntries * count) break;
    cell *= 1.5;
  }
  set_cell(cell, size);
}

void Cells::set_cell(double cell, Vec2d size) {
  cell_ = cell;
  columns_ = static_cast<std::size_t>(std::max(0.0, size.x / cell)) + 1;
  rows_ = static_cast<std::size_t>(std::max(0.0, size.y / cell)) + 1;
  head_.assign(columns_ * rows_, kEnd);
}

Cells::Range Cells::range(const PlaneBox& box) const {
  const auto at = [&](double distance, std::size_t count) {
    return std::min(count - 1, static_cast<std::size_t>(std::max(0.0, distance / cell_)));
  };
  return {at(box.min.x - origin_.x, columns_), at(box.min.y - origin_.y, rows_), at(box.max.x - origin_.x, columns_),
          at(box.max.y - origin_.y, rows_)};
}

void Cells::add(const PlaneBox& box, std::uint32_t index) {
  const Range r = range(box);
  for (std::size_t y = r.y0; y <= r.y1; ++y) {
    for (std::size_t x = r.x0; x <= r.x1; ++x) {
      entries_.push_back({index, head_[y * columns_ + x]});
      head_[y * columns_ + x] = static_cast<std::uint32_t>(entries_.size() - 1);
    }
  }
}

bool overlap(const FlatTriangle& a, const FlatTriangle& b) { return !side_separates(a, b) && !side_separates(b, a); }

bool rim_is_simple(const std::vector<RimSide>& rim) {
  const std::vector<std::uint32_t> next = followers(rim);
  if (next.empty() || outer_loops(rim, next) != 1) return false;
  std::vector<PlaneBox> boxes;
  boxes.reserve(rim.size());
  for (const RimSide& side : rim) boxes.push_back(box_of(std::array{side.from, side.to}));
  Cells cells(boxes);
  for (std::uint32_t i = 0; i < rim.size(); ++i) {
    const auto apart = [&](std::uint32_t other) {
      return boxes_apart(boxes[i], boxes[other]) || !meet(rim[i], rim[other]);
    };
    if (!cells.visit(boxes[i], apart)) return false;
    cells.add(boxes[i], i);
  }
  return true;
}

}  // namespace lodestone::bake::detail
