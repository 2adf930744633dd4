// Charts laid out in the plane so that nothing overlaps.
//
// Method: a chart is seen along its axis, the mean of its normals by area. All its triangles face the axis, so none is
// turned over; but parts may cover each other, and these are split off. See docs/papers/baking.md.
// 1. hull_of(), best_direction(): the box of least area around a chart lies along a side of its convex
//    hull (Andrew's monotone chain).
// 2. Flattener::flatten(): lays out a chart, then the connected pieces that had to be split off, and so on.
// 3. seen_along(), rim_of(), place(): if the rim shows that nothing is covered twice (rim_is_simple() in overlap.cpp),
//    the whole chart stays; else grow() adds triangles from the middle outward and leaves out what would cover one.
// 4. finish(): turns the chart upright, moves it to the origin and keeps its outline.
// 5. flatten_charts(): all charts, on all threads.
// Invariants: triangles wind counter-clockwise and no two of a chart overlap; each triangle comes out once. Charts are
// independent and keep their order: the same for any thread count. Cost: about linear where the triangles of a chart
// are of a size, as grow() looks for what is near in a grid of cells.
#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>

#include "lodestone/bake/flat_charts_detail.h"
#include "lodestone/bake/overlap_detail.h"
#include "lodestone/bake/plane_detail.h"
#include "lodestone/base/parallel.h"
#include "lodestone/math/triangle.h"

namespace lodestone::bake::detail {

namespace {

// Two unit vectors across the axis; first x second = axis.
std::array<Vec3d, 2> across(Vec3d axis) {
  const Vec3d a{std::abs(axis.x), std::abs(axis.y), std::abs(axis.z)};
  const Vec3d other = a.x <= a.y && a.x <= a.z ? Vec3d{1, 0, 0} : a.y <= a.z ? Vec3d{0, 1, 0} : Vec3d{0, 0, 1};
  const Vec3d first = normalized(lodestone::cross(other, axis));
  return {first, lodestone::cross(axis, first)};
}

// The convex hull, counter-clockwise (Andrew's monotone chain).
std::vector<Vec2d> hull_of(std::vector<Vec2d> points) {
  std::sort(points.begin(), points.end(), [](Vec2d l, Vec2d r) { return l.x != r.x ? l.x < r.x : l.y < r.y; });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  std::vector<Vec2d> hull;
  const auto chain = [&](auto begin, auto end) {
    const std::size_t base = hull.size();
    for (auto p = begin; p != end; ++p) {
      while (hull.size() >= base + 2 && cross(hull.back() - hull[hull.size() - 2], *p - hull.back()) <= 0) {
        hull.pop_back();
      }
      hull.push_back(*p);
    }
    hull.pop_back();
  };
  chain(points.begin(), points.end());
  chain(points.rbegin(), points.rend());
  return hull;
}

// The direction of the box of least area around the points: along a side of their hull, of which not all are tried
// where there are many.
constexpr std::size_t kMostDirections = 256;
Vec2d best_direction(const std::vector<FlatTriangle>& corners) {
  std::vector<Vec2d> points;
  points.reserve(corners.size() * 3);
  for (const FlatTriangle& t : corners) points.insert(points.end(), t.begin(), t.end());
  const std::vector<Vec2d> hull = hull_of(std::move(points));
  Vec2d best{0, 1};
  double least = 1e300;
  const std::size_t step = hull.size() / kMostDirections + 1;
  for (std::size_t i = 0; i < hull.size(); i += step) {
    Vec2d along = hull[(i + 1) % hull.size()] - hull[i];
    const double l = std::sqrt(dot(along, along));
    if (!(l > 0)) continue;
    along = {along.x / l, along.y / l};
    PlaneBox box;
    for (const Vec2d& p : hull) box.add({dot(p, along), cross(along, p)});
    const Vec2d size = box.size();
    if (size.x * size.y < least) {
      least = size.x * size.y;
      best = size.x <= size.y ? along : Vec2d{-along.y, along.x};  // a quarter turn makes it upright
    }
  }
  return best;
}

class Flattener {
 public:
  Flattener(const Mesh& mesh, const Neighbors& neighbors) : mesh_(mesh), neighbors_(neighbors) {}

  // Lays out a connected chart, and what had to be split off.
  std::vector<FlatChart> flatten(std::vector<std::uint32_t> triangles) const {
    std::vector<FlatChart> done;
    const Vec3d axis = axis_of(triangles);
    std::deque<std::vector<std::uint32_t>> waiting{std::move(triangles)};
    while (!waiting.empty()) {
      std::vector<std::uint32_t> rest;
      done.push_back(place(waiting.front(), axis, rest));
      waiting.pop_front();
      for (std::vector<std::uint32_t>& piece : connected(rest)) waiting.push_back(std::move(piece));
    }
    return done;
  }

 private:
  Vec3d axis_of(const std::vector<std::uint32_t>& triangles) const {
    Vec3d sum;
    for (const std::uint32_t t : triangles) {
      const auto [a, b, c] = corners(t);
      sum += scaled_normal(a, b, c);
    }
    const Vec3d axis = normalized(sum);
    return axis == Vec3d{} ? Vec3d{0, 0, 1} : axis;
  }
  std::array<Vec3d, 3> corners(std::uint32_t triangle) const {
    const Triangle v = mesh_.vertices_of(triangle);
    return {mesh_.position(v[0]), mesh_.position(v[1]), mesh_.position(v[2])};
  }

  // The sorted triangles as pieces that are connected over sides, in order of their first.
  std::vector<std::vector<std::uint32_t>> connected(const std::vector<std::uint32_t>& sorted) const {
    std::vector<std::vector<std::uint32_t>> pieces;
    std::vector<std::uint8_t> seen(sorted.size(), 0);
    for (std::size_t i = 0; i < sorted.size(); ++i) {
      if (seen[i] != 0) continue;
      std::vector<std::uint32_t> piece{sorted[i]};
      seen[i] = 1;
      for (std::size_t next = 0; next < piece.size(); ++next) {
        for (const std::uint32_t other : neighbors_[piece[next]]) {
          const std::optional<std::size_t> at = index_of(sorted, other);
          if (!at || seen[*at] != 0) continue;
          seen[*at] = 1;
          piece.push_back(other);
        }
      }
      std::sort(piece.begin(), piece.end());
      pieces.push_back(std::move(piece));
    }
    return pieces;
  }

  static std::optional<std::size_t> index_of(const std::vector<std::uint32_t>& sorted, std::uint32_t triangle) {
    const auto at = std::lower_bound(sorted.begin(), sorted.end(), triangle);
    if (at == sorted.end() || *at != triangle) return std::nullopt;
    return static_cast<std::size_t>(at - sorted.begin());
  }

  // As seen along the axis.
  std::vector<FlatTriangle> seen_along(Vec3d axis, const std::vector<std::uint32_t>& triangles) const {
    const auto [right, up] = across(axis);
    const Vec3d origin = corners(triangles[0])[0];
    std::vector<FlatTriangle> flat;
    flat.reserve(triangles.size());
    for (const std::uint32_t t : triangles) {
      FlatTriangle f;
      const std::array<Vec3d, 3> p = corners(t);
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3d d = p[k] - origin;
        f[k] = {lodestone::dot(d, right), lodestone::dot(d, up)};
      }
      flat.push_back(f);
    }
    return flat;
  }

  std::vector<RimSide> rim_of(const std::vector<std::uint32_t>& triangles,
                              const std::vector<FlatTriangle>& flat) const {
    std::vector<RimSide> rim;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      const Triangle v = mesh_.vertices_of(triangles[i]);
      for (std::size_t k = 0; k < 3; ++k) {
        if (index_of(triangles, neighbors_[triangles[i]][k])) continue;
        rim.push_back({flat[i][k], flat[i][(k + 1) % 3], v[k], v[(k + 1) % 3]});
      }
    }
    return rim;
  }

  // The sorted triangles as one chart; what would overlap stays in `rest`.
  FlatChart place(const std::vector<std::uint32_t>& triangles, Vec3d axis, std::vector<std::uint32_t>& rest) const {
    FlatChart chart;
    std::vector<FlatTriangle> flat = seen_along(axis, triangles);
    if (rim_is_simple(rim_of(triangles, flat))) {
      chart.triangles = triangles;
      chart.corners = std::move(flat);
    } else {
      const std::vector<std::uint8_t> placed = grow(triangles, flat);
      for (std::size_t i = 0; i < triangles.size(); ++i) {
        if (placed[i] == 0) {
          rest.push_back(triangles[i]);
          continue;
        }
        chart.triangles.push_back(triangles[i]);
        chart.corners.push_back(flat[i]);
      }
    }
    finish(chart);
    return chart;
  }

  // Grows from the triangle nearest to the middle outward, without those that overlap one placed before. Returns which
  // are placed.
  std::vector<std::uint8_t> grow(const std::vector<std::uint32_t>& triangles,
                                 const std::vector<FlatTriangle>& flat) const {
    std::vector<PlaneBox> boxes;
    boxes.reserve(flat.size());
    for (const FlatTriangle& t : flat) boxes.push_back(box_of(t));
    Cells cells(boxes);
    std::vector<std::uint8_t> reached(triangles.size(), 0), placed(triangles.size(), 0);
    std::vector<std::size_t> order{nearest_to_middle(flat)};
    reached[order[0]] = 1;
    for (std::size_t next = 0; next < order.size(); ++next) {
      const std::size_t i = order[next];
      if (!cells.visit(boxes[i], [&](std::uint32_t other) { return !overlap(flat[i], flat[other]); })) continue;
      cells.add(boxes[i], static_cast<std::uint32_t>(i));
      placed[i] = 1;
      for (const std::uint32_t other : neighbors_[triangles[i]]) {
        const std::optional<std::size_t> at = index_of(triangles, other);
        if (!at || reached[*at] != 0) continue;
        reached[*at] = 1;
        order.push_back(*at);
      }
    }
    return placed;
  }

  static std::size_t nearest_to_middle(const std::vector<FlatTriangle>& flat) {
    PlaneBox box;
    for (const FlatTriangle& t : flat) {
      for (const Vec2d& p : t) box.add(p);
    }
    const Vec2d twice{box.min.x + box.max.x, box.min.y + box.max.y};
    std::size_t best = 0;
    double least = 1e300;
    for (std::size_t i = 0; i < flat.size(); ++i) {
      const FlatTriangle& t = flat[i];
      const Vec2d d{(t[0].x + t[1].x + t[2].x) / 3 - twice.x / 2, (t[0].y + t[1].y + t[2].y) / 3 - twice.y / 2};
      if (dot(d, d) < least) {
        least = dot(d, d);
        best = i;
      }
    }
    return best;
  }

  // Turns the chart upright, moves it to the origin, and finds its outline.
  void finish(FlatChart& chart) const {
    const Vec2d along = best_direction(chart.corners);
    PlaneBox box;
    for (FlatTriangle& t : chart.corners) {
      for (Vec2d& p : t) {
        p = {dot(p, along), cross(along, p)};
        box.add(p);
      }
    }
    chart.size = box.size();
    for (std::size_t i = 0; i < chart.triangles.size(); ++i) {
      FlatTriangle& t = chart.corners[i];
      for (Vec2d& p : t) p = p - box.min;
      chart.area += std::abs(cross(t[1] - t[0], t[2] - t[0])) / 2;
    }
    for (const RimSide& side : rim_of(chart.triangles, chart.corners)) chart.outline.emplace_back(side.from, side.to);
    if (chart.outline.empty()) {  // triangles without area can close a chart
      for (const FlatTriangle& t : chart.corners) chart.outline.emplace_back(t[0], t[1]);
    }
  }

  const Mesh& mesh_;
  const Neighbors& neighbors_;
};

}  // namespace

std::vector<FlatChart> flatten_charts(const Mesh& mesh, const Neighbors& neighbors,
                                      const std::vector<std::uint32_t>& chart, const Task& task) {
  std::vector<std::vector<std::uint32_t>> members;
  for (std::uint32_t t = 0; t < chart.size(); ++t) {
    if (chart[t] >= members.size()) members.resize(chart[t] + std::size_t{1});
    members[chart[t]].push_back(t);
  }
  std::vector<std::vector<FlatChart>> flat(members.size());
  const Flattener flattener(mesh, neighbors);
  parallel_for(members.size(), 1, task,
               [&](std::size_t c, std::size_t, std::size_t) { flat[c] = flattener.flatten(std::move(members[c])); });
  std::vector<FlatChart> all;
  for (std::vector<FlatChart>& of_one : flat) {
    for (FlatChart& f : of_one) all.push_back(std::move(f));
  }
  return all;
}

}  // namespace lodestone::bake::detail
