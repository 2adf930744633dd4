// One direction of the distance between two surfaces: from points of the first to the second.
//
// Method: area-weighted stratified samples and all vertices, each to its closest point on the other surface; then the
// maximum is bounded from above. docs/measuring.md defines the figures.
// 1. measure_samples(): a chunk of samples: sums of distances, squares and angles between faces, and the largest.
// 2. spread(): percentiles and a histogram of the samples.
// 3. directed_distance(): samples, then vertices, which count in the maximum alone (vertex_distances.cpp),
//    then the bound (maximum_bound.cpp).
// Invariants: sample i depends on the surface, the seed and i alone; chunks have a fixed size and are joined in order:
// the same figures for any thread count.
// Cost: O((samples + vertices) log triangles); queries of neighbouring points share their work (closest_batch.cpp).
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "lodestone/base/parallel.h"
#include "lodestone/math/angle.h"
#include "lodestone/math/triangle.h"
#include "lodestone/measure/directed_detail.h"
#include "lodestone/measure/maximum_bound_detail.h"
#include "lodestone/measure/sampling_detail.h"
#include "lodestone/spatial/closest_batch.h"

namespace lodestone::measure::detail {

namespace {

constexpr std::size_t kChunk = 4096;
constexpr std::size_t kBins = 64;  // of the histogram

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

Sums measure_samples(const spatial::Surface& from, const spatial::Bvh& to, const Sampler& sampler,
                     std::span<float> distances, std::size_t begin, std::size_t end) {
  Sums sums;
  std::vector<Sample> samples;
  std::vector<Vec3d> points;
  sampler.for_each(begin, end, [&](std::size_t, const Sample& sample) {
    samples.push_back(sample);
    points.push_back(sample.point);
  });
  std::vector<spatial::Nearest> closest(points.size());
  spatial::ClosestBatch(to).find(points, closest);
  // Several samples in a row have the same triangle, and often the same nearest one.
  std::uint32_t triangle = kNone, other = kNone;
  Vec3d n, m;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Sample& sample = samples[i];
    const spatial::Nearest& nearest = closest[i];
    const double distance = std::sqrt(nearest.distance_sq);
    distances[begin + i] = static_cast<float>(distance);
    sums.distance += distance;
    sums.distance_sq += nearest.distance_sq;
    ++sums.samples;
    if (sample.triangle != triangle) {
      triangle = sample.triangle;
      n = unit_normal(from, triangle);
    }
    if (nearest.triangle != other) {
      other = nearest.triangle;
      m = unit_normal(to.surface(), other);
    }
    if (n != Vec3d{} && m != Vec3d{}) {
      sums.degrees += arc_cosine_degrees(dot(n, m));
      ++sums.with_normal;
    }
    sums.add({nearest.distance_sq, sample.triangle, sample.point});
  }
  return sums;
}

// Percentiles and histogram. Changes the order of the distances: each percentile is looked for above the one before.
void spread(std::vector<float>& distances, DirectedDistance& out, const Task& task) {
  auto from = distances.begin();
  const auto percentile = [&](double share) {
    const auto at = distances.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(distances.size() - 1));
    std::nth_element(from, at, distances.end());
    from = at;
    return static_cast<double>(*at);
  };
  out.median = percentile(0.5);
  out.percentile_95 = percentile(0.95);
  out.percentile_99 = percentile(0.99);
  const auto largest = static_cast<double>(*std::max_element(from, distances.end()));
  using Counts = std::array<std::uint64_t, kBins>;
  const Counts counts = parallel_reduce(
      distances.size(), kChunk * 16, task, Counts{},
      [&](std::size_t begin, std::size_t end) {
        Counts part{};
        for (std::size_t i = begin; i < end; ++i) {
          const double bin = largest > 0 ? static_cast<double>(distances[i]) / largest * static_cast<double>(kBins) : 0;
          ++part[std::min(kBins - 1, static_cast<std::size_t>(bin))];
        }
        return part;
      },
      [](Counts a, const Counts& b) {
        for (std::size_t i = 0; i < kBins; ++i) a[i] += b[i];
        return a;
      });
  out.histogram.assign(counts.begin(), counts.end());
  out.histogram_step = largest / static_cast<double>(kBins);
}

}  // namespace

DirectedDistance directed_distance(const spatial::Surface& from, const spatial::Bvh& to, const DistanceOptions& options,
                                   const Task& task) {
  const Sampler sampler(from, options.samples, options.seed);
  const std::uint64_t samples = sampler.count();
  const Task sampling = task.part(0.7);
  std::vector<float> distances(samples);
  Sums sums = parallel_reduce(
      samples, kChunk, sampling, Sums{},
      [&](std::size_t begin, std::size_t end) {
        Sums part = measure_samples(from, to, sampler, distances, begin, end);
        sampling.advance(static_cast<double>(end - begin) / static_cast<double>(samples));
        return part;
      },
      join);
  const VertexDistances vertices = vertex_distances(from, to, task);
  sums.add(vertices.peak);
  DirectedDistance out;
  if (task.cancelled() || sums.peak.triangle == kNone) return out;
  out.sampled_max = std::sqrt(sums.peak.distance_sq);
  MaximumBound bound{sums.peak, std::numeric_limits<double>::infinity()};
  if (options.bound) {
    const double diagonal = std::max(from.bounds.diagonal(), to.surface().bounds.diagonal());
    const BoundOptions search{options.tolerance, least_tolerance(diagonal, options),
                              options.queries > 0 ? options.queries : samples};
    bound = bound_maximum(from, to, spatial::triangle_neighbors(to.surface()), vertices.of, sums.peak, search,
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
    spread(distances, out, task);
  }
  if (sums.with_normal > 0) out.normal_degrees = sums.degrees / static_cast<double>(sums.with_normal);
  return out;
}

}  // namespace lodestone::measure::detail
