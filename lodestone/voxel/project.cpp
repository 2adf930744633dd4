#include "lodestone/voxel/project.h"

#include <algorithm>
#include <span>
#include <vector>

#include "lodestone/base/parallel.h"
#include "lodestone/spatial/closest_batch.h"
#include "lodestone/voxel/coincident_vertices_detail.h"

namespace lodestone::voxel {

namespace {

constexpr std::size_t kChunk = 4096;

Vec3f normal_of(const std::vector<Vec3f>& positions, const Triangle& t) {
  return cross(positions[t[1]] - positions[t[0]], positions[t[2]] - positions[t[0]]);
}

// Takes back moves that turn triangles over, until none does. Each round takes some back for good, so it ends.
std::size_t take_back_turned(const Mesh& mesh, const std::vector<Vec3f>& before, std::vector<Vec3f>& moved,
                             const Task& task) {
  std::size_t kept = 0;
  while (!task.cancelled()) {
    std::vector<std::uint8_t> turned(mesh.triangles.size(), 0);
    parallel_for(mesh.triangles.size(), kChunk, task, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t t = begin; t < end; ++t) {
        const Triangle& c = mesh.triangles[t];
        turned[t] = dot(normal_of(before, c), normal_of(moved, c)) > 0 ? 0 : 1;
      }
    });
    std::size_t count = 0;
    for (std::size_t t = 0; t < turned.size(); ++t) {
      if (turned[t] == 0) continue;
      for (const std::uint32_t v : mesh.triangles[t]) {
        if (moved[v] == before[v]) continue;
        moved[v] = before[v];
        ++count;
      }
    }
    kept += count;
    if (count == 0) break;
  }
  return kept;
}

}  // namespace

std::size_t project(Mesh& mesh, const spatial::Bvh& source, double most, const Task& task) {
  std::vector<Vec3f> moved = mesh.positions;
  const auto count = parallel_reduce(
      mesh.positions.size(), kChunk, task, std::size_t{0},
      [&](std::size_t begin, std::size_t end) {
        std::vector<Vec3d> points;
        for (std::size_t v = begin; v < end; ++v) points.push_back(mesh.position(static_cast<std::uint32_t>(v)));
        std::vector<spatial::Nearest> closest(points.size());
        spatial::ClosestBatch(source).find(points, closest);
        std::size_t near = 0;
        for (std::size_t v = begin; v < end; ++v) {
          const spatial::Nearest& nearest = closest[v - begin];
          if (!(nearest.distance_sq <= most * most)) continue;
          moved[v] = to_float(nearest.point - mesh.offset);
          ++near;
        }
        return near;
      },
      [](std::size_t a, std::size_t b) { return a + b; });
  if (task.cancelled()) return 0;
  detail::separate_coincident_vertices(mesh.positions, moved);
  const std::size_t taken_back = take_back_turned(mesh, mesh.positions, moved, task);
  mesh.positions = std::move(moved);
  return count - std::min(count, taken_back);
}

}  // namespace lodestone::voxel
