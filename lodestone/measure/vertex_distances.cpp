#include <cmath>
#include <span>
#include <vector>

#include "lodestone/base/parallel.h"
#include "lodestone/measure/maximum_bound_detail.h"
#include "lodestone/spatial/closest_batch.h"

namespace lodestone::measure::detail {

namespace {

constexpr std::size_t kChunk = 4096;

// Vertices in the surface's order, each with a triangle that has it.
std::vector<std::uint32_t> triangle_of_vertices(const spatial::Surface& surface) {
  std::vector<std::uint32_t> triangle(surface.positions.size(), kNone);
  for (std::size_t t = surface.triangles.size(); t-- > 0;) {
    for (const std::uint32_t v : surface.triangles[t]) triangle[v] = static_cast<std::uint32_t>(t);
  }
  return triangle;
}

Peak measure_range(const spatial::Surface& from, const spatial::Bvh& to, const std::vector<std::uint32_t>& triangle,
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

VertexDistances vertex_distances(const spatial::Surface& from, const spatial::Bvh& to, const Task& task) {
  const std::vector<std::uint32_t> triangle = triangle_of_vertices(from);
  VertexDistances out;
  out.of.resize(from.positions.size());
  out.peak = parallel_reduce(
      from.positions.size(), kChunk, task, Peak{},
      [&](std::size_t begin, std::size_t end) { return measure_range(from, to, triangle, out.of, begin, end); },
      [](const Peak& a, const Peak& b) { return is_higher(b, a) ? b : a; });
  return out;
}

}  // namespace lodestone::measure::detail
