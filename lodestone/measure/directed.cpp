// Method   area-weighted stratified samples and all vertices, each to its closest point on the other surface; then the
// surface around
//          the worst of them is subdivided until the maximum stands
// Cost     O((samples + vertices) log triangles); neighbouring queries hand each other a hint
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "lodestone/base/parallel.h"
#include "lodestone/math/triangle.h"
#include "lodestone/measure/directed_detail.h"
#include "lodestone/measure/sampling_detail.h"

namespace lodestone::measure::detail {

namespace {

constexpr std::size_t kChunk = 4096;
constexpr std::size_t kWorst = 32;  // candidates for sharpening, a chunk and in all

struct Peak {
  double distance_sq = -1;
  std::uint32_t triangle = kNone;  // of the first surface
  Vec3d at;
};

bool is_higher(const Peak& a, const Peak& b) {
  return a.distance_sq != b.distance_sq ? a.distance_sq > b.distance_sq : a.triangle < b.triangle;
}

// The highest peaks, at most one a triangle, highest first.
struct Peaks {
  std::vector<Peak> list;

  void add(const Peak& peak) {
    if (list.size() == kWorst && !is_higher(peak, list.back())) return;
    for (std::size_t i = 0; i < list.size(); ++i) {
      if (list[i].triangle != peak.triangle) continue;
      if (!is_higher(peak, list[i])) return;
      list.erase(list.begin() + static_cast<std::ptrdiff_t>(i));
      break;
    }
    list.insert(std::upper_bound(list.begin(), list.end(), peak, is_higher), peak);
    if (list.size() > kWorst) list.pop_back();
  }
};

struct Sums {
  double distance = 0, distance_sq = 0, degrees = 0;
  std::uint64_t samples = 0, with_normal = 0;
  Peaks peaks;
};

Sums join(Sums a, const Sums& b) {
  a.distance += b.distance;
  a.distance_sq += b.distance_sq;
  a.degrees += b.degrees;
  a.samples += b.samples;
  a.with_normal += b.with_normal;
  for (const Peak& peak : b.peaks.list) a.peaks.add(peak);
  return a;
}

Vec3d unit_normal(const spatial::Surface& surface, std::uint32_t triangle) {
  const auto [a, b, c] = surface.corners(triangle);
  return normalized(scaled_normal(a, b, c));
}

Sums measure_samples(const spatial::Surface& from, const spatial::Bvh& to, const Sampler& sampler, std::size_t begin,
                     std::size_t end) {
  Sums sums;
  std::uint32_t hint = kNone;
  sampler.for_each(begin, end, [&](std::size_t, const Sample& sample) {
    const spatial::Nearest nearest = to.closest(sample.point, hint);
    hint = nearest.triangle;
    sums.distance += std::sqrt(nearest.distance_sq);
    sums.distance_sq += nearest.distance_sq;
    ++sums.samples;
    const Vec3d n = unit_normal(from, sample.triangle), m = unit_normal(to.surface(), nearest.triangle);
    if (n != Vec3d{} && m != Vec3d{}) {
      // acos is not the same on every machine; this angle is for reading only, nothing is decided by it.
      sums.degrees += std::acos(std::clamp(dot(n, m), -1.0, 1.0)) * 180 / std::numbers::pi;
      ++sums.with_normal;
    }
    sums.peaks.add({nearest.distance_sq, sample.triangle, sample.point});
  });
  return sums;
}

// Vertices in the surface's order, each with a triangle that has it.
std::vector<std::uint32_t> triangle_of_vertices(const spatial::Surface& surface) {
  std::vector<std::uint32_t> triangle(surface.positions.size(), kNone);
  for (std::size_t t = surface.triangles.size(); t-- > 0;) {
    for (const std::uint32_t v : surface.triangles[t]) triangle[v] = static_cast<std::uint32_t>(t);
  }
  return triangle;
}

Sums measure_vertices(const spatial::Surface& from, const spatial::Bvh& to, const std::vector<std::uint32_t>& triangle,
                      std::size_t begin, std::size_t end) {
  Sums sums;
  std::uint32_t hint = kNone;
  for (std::size_t v = begin; v < end; ++v) {
    if (triangle[v] == kNone) continue;
    const spatial::Nearest nearest = to.closest(from.positions[v], hint);
    hint = nearest.triangle;
    sums.peaks.add({nearest.distance_sq, triangle[v], from.positions[v]});
  }
  return sums;
}

// Cuts the triangle of a peak into ever smaller quarters where the distance could still exceed the maximum by 1 %:
// nowhere on a piece is it more than at its centre plus the piece's radius. Bounded by a budget of queries.
Peak sharpen_peak(const spatial::Surface& from, const spatial::Bvh& to, const Peak& peak, double known_max) {
  struct Piece {
    std::array<Vec3d, 3> corners;
    double distance, reach;
  };
  Peak best = peak;
  double max = std::max(known_max, std::sqrt(peak.distance_sq));
  std::uint32_t hint = kNone;
  int budget = 2000;
  const auto measured = [&](const std::array<Vec3d, 3>& c) {
    const Vec3d center = (c[0] + c[1] + c[2]) / 3.0;
    const spatial::Nearest nearest = to.closest(center, hint);
    hint = nearest.triangle;
    --budget;
    if (nearest.distance_sq > best.distance_sq) best = {nearest.distance_sq, peak.triangle, center};
    const double d = std::sqrt(nearest.distance_sq);
    max = std::max(max, d);
    return Piece{c, d,
                 std::sqrt(std::max({length_sq(c[0] - center), length_sq(c[1] - center), length_sq(c[2] - center)}))};
  };
  const auto promise = [](const Piece& a, const Piece& b) { return a.distance + a.reach < b.distance + b.reach; };
  std::vector<Piece> heap{measured(from.corners(peak.triangle))};
  while (!heap.empty() && budget > 0) {
    std::pop_heap(heap.begin(), heap.end(), promise);
    const Piece piece = heap.back();
    heap.pop_back();
    if (piece.distance + piece.reach <= 1.01 * max) break;
    const auto [a, b, c] = piece.corners;
    const Vec3d ab = (a + b) * 0.5, bc = (b + c) * 0.5, ca = (c + a) * 0.5;
    for (const std::array<Vec3d, 3>& quarter : {std::array{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {bc, ca, ab}}) {
      heap.push_back(measured(quarter));
      std::push_heap(heap.begin(), heap.end(), promise);
    }
  }
  return best;
}

Peak sharpen(const spatial::Surface& from, const spatial::Bvh& to, const Peaks& peaks, const Task& task) {
  const double known = std::sqrt(peaks.list.front().distance_sq);
  std::vector<Peak> found(peaks.list.size());
  parallel_for(found.size(), 1, task, [&](std::size_t i, std::size_t, std::size_t) {
    found[i] = sharpen_peak(from, to, peaks.list[i], known);
  });
  return *std::min_element(found.begin(), found.end(), is_higher);
}

}  // namespace

DirectedDistance directed_distance(const spatial::Surface& from, const spatial::Bvh& to, const DistanceOptions& options,
                                   const Task& task) {
  const Sampler sampler(from, options.samples, options.seed);
  const std::uint64_t samples = sampler.count();
  const Task sampling = task.part(0.7);
  Sums sums = parallel_reduce(
      samples, kChunk, sampling, Sums{},
      [&](std::size_t begin, std::size_t end) {
        Sums part = measure_samples(from, to, sampler, begin, end);
        sampling.advance(static_cast<double>(end - begin) / static_cast<double>(samples));
        return part;
      },
      join);
  const std::vector<std::uint32_t> triangle = triangle_of_vertices(from);
  sums = join(
      std::move(sums),
      parallel_reduce(
          from.positions.size(), kChunk, task, Sums{},
          [&](std::size_t begin, std::size_t end) { return measure_vertices(from, to, triangle, begin, end); }, join));
  DirectedDistance out;
  if (task.cancelled() || sums.peaks.list.empty()) return out;
  Peak peak = sums.peaks.list.front();
  out.sampled_max = std::sqrt(peak.distance_sq);
  if (options.sharpen && peak.distance_sq > 0) peak = sharpen(from, to, sums.peaks, task);
  if (task.cancelled()) return out;
  out.max = std::sqrt(peak.distance_sq);
  out.max_at = peak.at;
  if (sums.samples > 0) {
    const auto n = static_cast<double>(sums.samples);
    out.mean = sums.distance / n;
    out.rms = std::sqrt(sums.distance_sq / n);
  }
  if (sums.with_normal > 0) out.normal_degrees = sums.degrees / static_cast<double>(sums.with_normal);
  return out;
}

}  // namespace lodestone::measure::detail
