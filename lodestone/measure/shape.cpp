#include "lodestone/measure/shape.h"

#include "lodestone/base/parallel.h"
#include "lodestone/core/validate.h"

namespace lodestone::measure {

namespace {

// Adds what one mesh has, `times` over.
void add_topology(Topology& sum, const Topology& one, std::uint64_t times) {
  sum.vertices += times * one.vertices;
  sum.wedges += times * one.wedges;
  sum.triangles += times * one.triangles;
  sum.degenerate_triangles += times * one.degenerate_triangles;
  sum.duplicate_faces += times * one.duplicate_faces;
  sum.edges += times * one.edges;
  sum.boundary_edges += times * one.boundary_edges;
  sum.hidden_boundary_edges += times * one.hidden_boundary_edges;
  sum.nonmanifold_edges += times * one.nonmanifold_edges;
  sum.inconsistent_edges += times * one.inconsistent_edges;
  sum.nonmanifold_vertices += times * one.nonmanifold_vertices;
  sum.components += times * one.components;
  sum.closed = sum.closed && one.closed;
  sum.manifold = sum.manifold && one.manifold;
}

// Area and signed volume of a mesh where an instance puts it.
void add_measures(Shape& shape, const Mesh& mesh, const Mat4d& transform, Vec3d center, const Task& task) {
  struct Sums {
    double area = 0, volume = 0;
  };
  const auto of_block = [&](std::size_t begin, std::size_t end) {
    Sums sums;
    for (std::size_t i = begin; i < end; ++i) {
      const Triangle t = mesh.vertices_of(i);
      const Vec3d a = transform.point(mesh.position(t[0])) - center;
      const Vec3d b = transform.point(mesh.position(t[1])) - center;
      const Vec3d c = transform.point(mesh.position(t[2])) - center;
      sums.area += length(cross(b - a, c - a)) / 2;
      sums.volume += dot(a, cross(b, c)) / 6;
    }
    return sums;
  };
  constexpr std::size_t kBlock = 16384;
  const Sums sums =
      parallel_reduce(mesh.triangles.size(), kBlock, task, Sums{}, of_block, [](const Sums& a, const Sums& b) {
        return Sums{a.area + b.area, a.volume + b.volume};
      });
  shape.area += sums.area;
  // A mirror turns the faces, a renderer turns them back.
  shape.volume += transform.determinant3() < 0 ? -sums.volume : sums.volume;
}

// By Euler's formula: vertices - edges + triangles = 2 (pieces - handles).
std::optional<std::int64_t> genus_of(const Topology& t) {
  if (!t.closed || !t.manifold || t.inconsistent_edges > 0) return {};
  const auto proper = static_cast<std::int64_t>(t.edges * 2 / 3);  // triangles, but for those with a repeated vertex
  const std::int64_t euler = static_cast<std::int64_t>(t.vertices) - static_cast<std::int64_t>(t.edges) + proper;
  return static_cast<std::int64_t>(t.components) - euler / 2;
}

}  // namespace

Result<Shape> shape_of(const Model& model, const Task& task) {
  LODESTONE_TRY(validate(model, task));
  const std::vector<std::uint32_t> counts = instance_counts(model);
  Shape shape;
  shape.topology.closed = shape.topology.manifold = true;
  bool drawn = false;
  for (std::size_t i = 0; i < model.meshes.size(); ++i) {
    if (counts[i] == 0) continue;
    drawn = true;
    add_topology(shape.topology, topology_of(model.meshes[i], task), counts[i]);
    if (task.cancelled()) return cancelled_error("counting");
  }
  if (!drawn) shape.topology.closed = shape.topology.manifold = false;
  const Vec3d center = bounds_of(model).center();
  for (const Instance& instance : model.instances) {
    add_measures(shape, model.meshes[instance.mesh], instance.transform, center, task);
    if (task.cancelled()) return cancelled_error("measuring");
  }
  shape.genus = genus_of(shape.topology);
  return shape;
}

}  // namespace lodestone::measure
