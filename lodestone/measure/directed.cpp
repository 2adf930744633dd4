// Method   area-weighted stratified samples and all vertices, each to its closest point on the other surface; then the
//          maximum is bounded from above (hausdorff.cpp)
// Cost     O((samples + vertices) log triangles); neighbouring queries hand each other a hint
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "lodestone/base/parallel.h"
#include "lodestone/math/triangle.h"
#include "lodestone/measure/directed_detail.h"
#include "lodestone/measure/hausdorff_detail.h"
#include "lodestone/measure/sampling_detail.h"
#include "lodestone/spatial/closest_batch.h"

namespace lodestone::measure::detail {

namespace {

constexpr std::size_t kChunk = 4096;

struct Sums {
  double distance = 0, distance_sq = 0, degrees = 0;
  std::uint64_t samples = 0, with_normal = 0;
  Peak peak;

  void add(const Peak& other) {
    if (is_higher(other, peak)) peak = other;
  }
};

Sums join(Sums a, const Sums& b) {
  a.distance += b.distance;
  a.distance_sq += b.distance_sq;
  a.degrees += b.degrees;
  a.samples += b.samples;
  a.with_normal += b.with_normal;
  a.add(b.peak);
  return a;
}

Vec3d unit_normal(const spatial::Surface& surface, std::uint32_t triangle) {
  const auto [a, b, c] = surface.corners(triangle);
  return normalized(scaled_normal(a, b, c));
}

Sums measure_samples(const spatial::Surface& from, const spatial::Bvh& to, const Sampler& sampler, std::size_t begin,
                     std::size_t end) {
  Sums sums;
  std::vector<Sample> samples;
  std::vector<Vec3d> points;
  sampler.for_each(begin, end, [&](std::size_t, const Sample& sample) {
    samples.push_back(sample);
    points.push_back(sample.point);
  });
  std::vector<spatial::Nearest> closest(points.size());
  spatial::ClosestBatch(to).find(points, closest);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Sample& sample = samples[i];
    const spatial::Nearest& nearest = closest[i];
    sums.distance += std::sqrt(nearest.distance_sq);
    sums.distance_sq += nearest.distance_sq;
    ++sums.samples;
    const Vec3d n = unit_normal(from, sample.triangle), m = unit_normal(to.surface(), nearest.triangle);
    if (n != Vec3d{} && m != Vec3d{}) {
      // acos is not the same on every machine; this angle is for reading only, nothing is decided by it.
      sums.degrees += std::acos(std::clamp(dot(n, m), -1.0, 1.0)) * 180 / std::numbers::pi;
      ++sums.with_normal;
    }
    sums.add({nearest.distance_sq, sample.triangle, sample.point});
  }
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

Peak measure_vertices(const spatial::Surface& from, const spatial::Bvh& to, const std::vector<std::uint32_t>& triangle,
                      std::vector<VertexDistance>& at_vertices, std::size_t begin, std::size_t end) {
  const std::span<const Vec3d> points = std::span(from.positions).subspan(begin, end - begin);
  std::vector<spatial::Nearest> closest(points.size());
  spatial::ClosestBatch(to).find(points, closest);
  Peak highest;
  for (std::size_t v = begin; v < end; ++v) {
    if (triangle[v] == kNone) continue;
    const spatial::Nearest& nearest = closest[v - begin];
    at_vertices[v] = {std::sqrt(nearest.distance_sq), nearest.triangle};
    const Peak peak{nearest.distance_sq, triangle[v], from.positions[v]};
    if (is_higher(peak, highest)) highest = peak;
  }
  return highest;
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
  std::vector<VertexDistance> at_vertices(from.positions.size());
  sums.add(parallel_reduce(
      from.positions.size(), kChunk, task, Peak{},
      [&](std::size_t begin, std::size_t end) { return measure_vertices(from, to, triangle, at_vertices, begin, end); },
      [](const Peak& a, const Peak& b) { return is_higher(b, a) ? b : a; }));
  DirectedDistance out;
  if (task.cancelled() || sums.peak.triangle == kNone) return out;
  out.sampled_max = std::sqrt(sums.peak.distance_sq);
  MaximumBound bound{sums.peak, std::numeric_limits<double>::infinity()};
  if (options.bound) {
    const double diagonal = std::max(from.bounds.diagonal(), to.surface().bounds.diagonal());
    const BoundOptions search{options.tolerance, kBoundFloor * diagonal,
                              options.queries > 0 ? options.queries : samples};
    bound = bound_maximum(from, to, spatial::triangle_neighbors(to.surface()), at_vertices, sums.peak, search,
                          task.part(0.3));
  }
  if (task.cancelled()) return out;
  out.max = std::sqrt(bound.peak.distance_sq);
  out.max_at = bound.peak.at;
  out.bound = bound.upper;
  if (sums.samples > 0) {
    const auto n = static_cast<double>(sums.samples);
    out.mean = sums.distance / n;
    out.rms = std::sqrt(sums.distance_sq / n);
  }
  if (sums.with_normal > 0) out.normal_degrees = sums.degrees / static_cast<double>(sums.with_normal);
  return out;
}

}  // namespace lodestone::measure::detail
