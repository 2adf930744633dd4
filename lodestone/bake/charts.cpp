// Charts: a surface cut into pieces that are nearly flat, to be laid out in a texture.
//
// Method: each triangle is a chart at first; of all pairs of neighbours the one with the lowest cost is merged, again
// and again (M. Garland, A. Willmott and P. Heckbert, Hierarchical Face Clustering on Polygonal Surfaces, 2001
// [garland-2001]). The cost is the area of a disc with the merged chart's perimeter, which keeps charts compact, plus
// kBend times how far the chart is from flat: its area less the length of its normals summed by area (D. Cohen-Steiner,
// P. Alliez and M. Desbrun, Variational Shape Approximation, 2004 [cohen-steiner-2004]).
// 1. Clustering(): a chart a triangle, with the length of the border that it has with each neighbour.
// 2. push(): queues a pair by its cost, unless it is too far from flat.
// 3. lowest_cosine(), allowed(): whether every triangle of both faces the common axis, by bounds that are known of
//    charts and of patches of triangles, and by the triangles where these don't suffice.
// 4. join_sides(), join(): merges two charts; their versions put older entries of the queue out of date.
// 5. merge(): until the queue is empty. make_charts() calls it twice, the second time with less strict limits for
//    charts smaller than 1/250 of the whole.
// Invariants: a chart is connected over sides, and all its triangles face its axis. One thread; the order of merges
// depends on the mesh alone. Cost: O(n log n).
#include <algorithm>
#include <cmath>

#include "lodestone/bake/bucket_queue_detail.h"
#include "lodestone/bake/charts_detail.h"
#include "lodestone/core/adjacency.h"
#include "lodestone/math/triangle.h"

namespace lodestone::bake::detail {

namespace {

// What a merged chart has to keep.
struct Limits {
  double deviation;   // at most: 1 - length of the mean normal
  double min_cosine;  // of each triangle with the axis, at least
  double small_area;  // one of the two must be below it
};

constexpr double kBend = 8;  // what the error counts beside the perimeter

struct ChartBorder {
  std::uint32_t chart;
  double length;  // of the border with it
};

struct Chart {
  Vec3d normal;  // sum of unit normal x area
  double area = 0, perimeter = 0;
  double cosine = 1;  // no triangle is farther from the axis than this says
  std::uint32_t version = 0;
  std::uint32_t first = 0, last = 0, size = 1;  // its patches, as a list
  std::vector<ChartBorder> sides;               // by rising chart
};

// Some triangles of a chart that were joined early and so point much the same way: most can be judged as one.
struct Patch {
  Vec3d axis;
  double cosine = 1;                  // of the triangle farthest from the axis
  std::uint32_t first = 0, last = 0;  // its triangles, as a list
  std::uint32_t next = kNone;         // in its chart
};
constexpr std::uint32_t kMostOfPatch = 64;

// Two charts that may be merged; out of date once either has been merged.
struct Candidate {
  std::uint32_t a, b, version_a, version_b;
};

// Cosine of the sum of two angles, both below 180 degrees.
double cosine_of_sum(double a, double b) {
  return a * b - std::sqrt(std::max(0.0, 1 - a * a)) * std::sqrt(std::max(0.0, 1 - b * b));
}

class Clustering {
 public:
  Clustering(const Mesh& mesh, const Neighbors& neighbors);
  void merge(const Limits& limits, const Task& task);
  double area() const { return area_; }
  std::vector<std::uint32_t> numbers() const;

 private:
  void push(std::uint32_t a, const ChartBorder& side, const Limits& limits);
  bool allowed(const Chart& a, const Chart& b, double min_cosine, double& cosine) const;
  double lowest_cosine(const Patch& patch, Vec3d axis, double enough) const;
  double lowest_cosine(const Chart& chart, Vec3d axis, double enough) const;
  void join(std::uint32_t a, std::uint32_t b, double cosine);
  void join_sides(std::uint32_t a, std::uint32_t b);

  std::vector<Vec3d> normals_;        // unit, of triangles; zero without area
  std::vector<std::uint32_t> next_;   // in the lists of triangles
  std::vector<Patch> patches_;        // one a triangle at first
  std::vector<Chart> charts_;         // likewise
  std::vector<std::uint8_t> merged_;  // into another
  BucketQueue<Candidate> queue_;
  double area_ = 0;
};

Clustering::Clustering(const Mesh& mesh, const Neighbors& neighbors)
    : normals_(mesh.triangles.size()),
      next_(mesh.triangles.size(), kNone),
      patches_(mesh.triangles.size()),
      charts_(mesh.triangles.size()),
      merged_(mesh.triangles.size(), 0) {
  for (std::uint32_t t = 0; t < charts_.size(); ++t) {
    Chart& chart = charts_[t];
    const Triangle v = mesh.vertices_of(t);
    const std::array<Vec3d, 3> p{mesh.position(v[0]), mesh.position(v[1]), mesh.position(v[2])};
    const Vec3d n = scaled_normal(p[0], p[1], p[2]);
    normals_[t] = normalized(n);
    patches_[t] = {normals_[t], 1, t, t, kNone};
    chart.normal = n / 2.0;
    chart.area = length(n) / 2;
    chart.first = chart.last = t;
    area_ += chart.area;
    for (std::size_t k = 0; k < 3; ++k) {
      const double side = length(p[(k + 1) % 3] - p[k]);
      chart.perimeter += side;
      const std::uint32_t other = neighbors[t][k];
      if (other == kNone) continue;
      const auto at =
          std::find_if(chart.sides.begin(), chart.sides.end(), [&](const ChartBorder& s) { return s.chart == other; });
      if (at == chart.sides.end()) {
        chart.sides.push_back({other, side});
      } else {
        at->length += side;
      }
    }
    std::sort(chart.sides.begin(), chart.sides.end(),
              [](const ChartBorder& l, const ChartBorder& r) { return l.chart < r.chart; });
  }
}

void Clustering::push(std::uint32_t a, const ChartBorder& side, const Limits& limits) {
  const std::uint32_t b = side.chart;
  const Chart &first = charts_[a], &second = charts_[b];
  if (!(std::min(first.area, second.area) < limits.small_area)) return;
  const double area = first.area + second.area;
  const double error = std::max(0.0, area - length(first.normal + second.normal));
  if (error > limits.deviation * area) return;
  const double perimeter = std::max(0.0, first.perimeter + second.perimeter - 2 * side.length);
  constexpr double kDisc = 1 / (4 * 3.14159265358979323846);  // perimeter squared x this is a disc's area
  const double cost = perimeter * perimeter * kDisc + kBend * error;
  queue_.push(static_cast<float>(cost / area_),
              a < b ? Candidate{a, b, first.version, second.version} : Candidate{b, a, second.version, first.version});
}

// The lowest cosine between triangles of the patch and the axis; stops at one below `enough`.
double Clustering::lowest_cosine(const Patch& patch, Vec3d axis, double enough) const {
  double lowest = 1;
  for (std::uint32_t t = patch.first; t != kNone && lowest >= enough; t = next_[t]) {
    if (normals_[t] != Vec3d{}) lowest = std::min(lowest, dot(normals_[t], axis));
  }
  return lowest;
}

// A cosine that no triangle of the chart falls below, if that is `enough` or more; else something below `enough`.
double Clustering::lowest_cosine(const Chart& chart, Vec3d axis, double enough) const {
  double lowest = 1;
  for (std::uint32_t p = chart.first; p != kNone && lowest >= enough; p = patches_[p].next) {
    const Patch& patch = patches_[p];
    const double bound = cosine_of_sum(patch.cosine, std::clamp(dot(patch.axis, axis), -1.0, 1.0));
    lowest = std::min(lowest, bound >= enough ? bound : lowest_cosine(patch, axis, enough));
  }
  return lowest;
}

// Whether all triangles of both face their common axis: by what is known of the charts, else triangle by triangle.
bool Clustering::allowed(const Chart& a, const Chart& b, double min_cosine, double& cosine) const {
  const Vec3d axis = normalized(a.normal + b.normal);
  cosine = 1;
  for (const Chart* chart : {a.size < b.size ? &a : &b, a.size < b.size ? &b : &a}) {
    if (chart->area <= 0) continue;
    const double bound = cosine_of_sum(chart->cosine, std::clamp(dot(normalized(chart->normal), axis), -1.0, 1.0));
    const double known = bound >= min_cosine ? bound : lowest_cosine(*chart, axis, min_cosine);
    if (known < min_cosine) return false;
    cosine = std::min(cosine, known);
  }
  return true;
}

// What b borders on, a does from now on.
void Clustering::join_sides(std::uint32_t a, std::uint32_t b) {
  Chart &into = charts_[a], &from = charts_[b];
  double common = 0;
  for (const ChartBorder& side : from.sides) {
    if (side.chart == a) {
      common = side.length;
      continue;
    }
    std::vector<ChartBorder>& theirs = charts_[side.chart].sides;
    std::erase_if(theirs, [&](const ChartBorder& s) { return s.chart == b; });
    const auto at = std::lower_bound(theirs.begin(), theirs.end(), a,
                                     [](const ChartBorder& s, std::uint32_t c) { return s.chart < c; });
    if (at != theirs.end() && at->chart == a) {
      at->length += side.length;
    } else {
      theirs.insert(at, {a, side.length});
    }
  }
  std::vector<ChartBorder> sides;
  sides.reserve(into.sides.size() + from.sides.size());
  std::merge(into.sides.begin(), into.sides.end(), from.sides.begin(), from.sides.end(), std::back_inserter(sides),
             [](const ChartBorder& l, const ChartBorder& r) { return l.chart < r.chart; });
  into.sides.clear();
  for (const ChartBorder& side : sides) {
    if (side.chart == a || side.chart == b) continue;
    if (!into.sides.empty() && into.sides.back().chart == side.chart) {
      into.sides.back().length += side.length;
    } else {
      into.sides.push_back(side);
    }
  }
  from.sides = {};
  into.perimeter = std::max(0.0, into.perimeter + from.perimeter - 2 * common);
}

// b becomes part of a.
void Clustering::join(std::uint32_t a, std::uint32_t b, double cosine) {
  join_sides(a, b);
  Chart &into = charts_[a], &from = charts_[b];
  into.normal += from.normal;
  into.area += from.area;
  into.cosine = cosine;
  into.size += from.size;
  if (into.size <= kMostOfPatch) {
    Patch& patch = patches_[into.first];
    next_[patch.last] = patches_[from.first].first;
    patch.last = patches_[from.first].last;
    patch.axis = normalized(into.normal);
    patch.cosine = lowest_cosine(patch, patch.axis, -1);
  } else {
    patches_[into.last].next = from.first;
    into.last = from.last;
  }
  ++into.version;
  ++from.version;
  merged_[b] = 1;
}

void Clustering::merge(const Limits& limits, const Task& task) {
  for (std::uint32_t a = 0; a < charts_.size(); ++a) {
    for (const ChartBorder& side : charts_[a].sides) {
      if (a < side.chart) push(a, side, limits);
    }
  }
  for (std::size_t i = 0; !queue_.empty(); ++i) {
    if (i % 4096 == 0 && task.cancelled()) return;
    const Candidate top = queue_.pop();
    if (charts_[top.a].version != top.version_a || charts_[top.b].version != top.version_b) continue;
    double cosine = 1;
    if (!allowed(charts_[top.a], charts_[top.b], limits.min_cosine, cosine)) continue;
    join(top.a, top.b, cosine);
    for (const ChartBorder& side : charts_[top.a].sides) push(top.a, side, limits);
  }
}

std::vector<std::uint32_t> Clustering::numbers() const {
  std::vector<std::uint32_t> chart(charts_.size(), kNone);
  for (std::uint32_t c = 0; c < charts_.size(); ++c) {
    if (merged_[c] != 0) continue;
    for (std::uint32_t p = charts_[c].first; p != kNone; p = patches_[p].next) {
      for (std::uint32_t t = patches_[p].first; t != kNone; t = next_[t]) chart[t] = c;
    }
  }
  std::vector<std::uint32_t> name(charts_.size(), kNone);
  std::uint32_t count = 0;
  for (std::uint32_t& c : chart) {
    if (name[c] == kNone) name[c] = count++;
    c = name[c];
  }
  return chart;
}

}  // namespace

Neighbors neighbors_of(const Mesh& mesh, const Task& task) {
  Neighbors neighbors(mesh.triangles.size(), {kNone, kNone, kNone});
  const EdgeTriangles edges = edge_triangles(mesh, task);
  for (const Edge& edge : edges.edges) {
    if (edge.count != 2) continue;
    const std::span<const std::uint32_t> two = edges.of(edge);
    if (two[0] == two[1]) continue;
    for (std::size_t i = 0; i < 2; ++i) {
      const Triangle v = mesh.vertices_of(two[i]);
      for (std::size_t k = 0; k < 3; ++k) {
        if (std::min(v[k], v[(k + 1) % 3]) == edge.a && std::max(v[k], v[(k + 1) % 3]) == edge.b) {
          neighbors[two[i]][k] = two[1 - i];
        }
      }
    }
  }
  return neighbors;
}

std::vector<std::uint32_t> make_charts(const Mesh& mesh, const Neighbors& neighbors, const Task& task) {
  Clustering clustering(mesh, neighbors);
  const double all = clustering.area();
  clustering.merge({0.2, 0.4, all * 2}, task);
  // Small charts that noise and sharp bends have left over go to a neighbour, to whose axis they may be more tilted.
  clustering.merge({0.4, 0.2, all * 0.004}, task);
  return clustering.numbers();
}

}  // namespace lodestone::bake::detail
