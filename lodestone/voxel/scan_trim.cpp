#include <algorithm>
#include <array>
#include <vector>

#include "lodestone/base/parallel.h"
#include "lodestone/core/validate.h"
#include "lodestone/spatial/kd_tree.h"
#include "lodestone/voxel/scan.h"

namespace lodestone::voxel {

namespace {

// One of each vertex that is nearer than `most` to a point.
std::vector<std::uint8_t> near_points(const Mesh& mesh, const PointCloud& cloud, double most, const Task& task) {
  const spatial::KdTree tree(cloud.positions, task);
  const Vec3d shift = mesh.offset - cloud.offset;
  std::vector<std::uint8_t> near(mesh.vertex_count(), 0);
  parallel_for(near.size(), 1024, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    std::array<spatial::Neighbor, 1> nearest;
    for (std::size_t v = begin; v < end; ++v) {
      near[v] = tree.nearest(to_double(mesh.positions[v]) + shift, nearest, most * most) > 0 ? 1 : 0;
    }
  });
  return near;
}

}  // namespace

Result<Mesh> trim_to_points(const Mesh& mesh, const PointCloud& cloud, double most, const Task& task) {
  if (cloud.positions.empty()) return fail(ErrorCode::empty, "there are no points", "scan");
  LODESTONE_TRY(validate(cloud, task));
  LODESTONE_TRY(validate(mesh, task));
  const std::vector<std::uint8_t> near = near_points(mesh, cloud, most, task);
  if (task.cancelled()) return cancelled_error("scan");
  Mesh out;
  out.name = mesh.name;
  out.offset = mesh.offset;
  std::vector<std::uint32_t> moved(mesh.vertex_count(), kNone);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    Triangle corners = mesh.vertices_of(t);
    if (!std::all_of(corners.begin(), corners.end(), [&](std::uint32_t v) { return near[v] != 0; })) continue;
    for (std::uint32_t& v : corners) {
      if (moved[v] == kNone) {
        moved[v] = static_cast<std::uint32_t>(out.positions.size());
        out.positions.push_back(mesh.positions[v]);
      }
      v = moved[v];
    }
    out.triangles.push_back(corners);
  }
  if (out.triangles.empty()) return fail(ErrorCode::empty, "no part of the surface is near a point", "scan");
  return out;
}

}  // namespace lodestone::voxel
