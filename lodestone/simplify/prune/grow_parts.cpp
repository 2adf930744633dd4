// Growing parts: those that are left of a mesh of many small pieces take over the area of those that have vanished
// (docs/thin-parts.md, "How parts grow").
//
// grow_parts():
// 1. parts_of_vertices(): which part of the original each vertex of the level belongs to.
// 2. measure(): area, centroid, principal axes and extent of each part as it is now (part_shape_detail.h).
// 3. steps_for(): how far each part's fastest end must move for the area that the part stands for. The shape's formula
//    foretells too little area for round parts, so two corrections follow, by the area that really comes out. No vertex
//    moves farther than `most`, and a part that would need more than twice as far does not grow.
// 4. enlarging(): the linear map of each part about its centroid, along its principal axes. It is applied to positions,
//    and to normals, tangents and morph targets as each of them needs it (change_stream()).
//
// Parts that hold a locked vertex (no_prune) do not grow. The topology and the triangles' numbers stay as they are.
// Single-threaded, in a fixed order. O(mesh).
#include "lodestone/simplify/prune/grow_parts.h"

#include <algorithm>

#include "lodestone/simplify/prune/part_shape_detail.h"

namespace lodestone::simplify {

namespace {

using detail::PartMeasure;
using detail::PartShape;

// Area that rounding alone may cost.
constexpr double kSame = 1.000001;

std::vector<std::uint32_t> parts_of_vertices(const Mesh& original, const Parts& parts,
                                             const std::vector<std::uint32_t>& origin, const Mesh& mesh) {
  std::vector<std::uint32_t> part_of(mesh.vertex_count(), kNone);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle o = original.vertices_of(origin[t]);
    if (o[0] == o[1] || o[1] == o[2] || o[2] == o[0]) continue;  // stays on request
    for (const std::uint32_t v : mesh.vertices_of(t)) part_of[v] = parts.of_vertex[o[0]];
  }
  return part_of;
}

std::vector<PartMeasure> measure(const Mesh& mesh, const std::vector<std::uint32_t>& part_of, std::size_t parts,
                                 const Mat4d& metric) {
  std::vector<PartMeasure> measures(parts);
  const auto placed = [&](std::uint32_t v) { return metric.direction(to_double(mesh.positions[v])); };
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle v = mesh.vertices_of(t);
    if (part_of[v[0]] != kNone) measures[part_of[v[0]]].add_triangle(placed(v[0]), placed(v[1]), placed(v[2]));
  }
  for (PartMeasure& m : measures) m.end_triangles();
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    if (part_of[v] != kNone) measures[part_of[v]].add_vertex(placed(v));
  }
  for (PartMeasure& m : measures) m.end_vertices();
  return measures;
}

// What happens to a part: x -> center + map (x - center), in the mesh's own space.
struct Enlarging {
  bool any = false;
  Vec3d center;
  Mat4d map, for_normals;
};

Mat4d transposed3(const Mat4d& m) {
  Mat4d out = m;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) out.m[i * 4 + j] = m.m[j * 4 + i];
  }
  return out;
}

Enlarging enlarging(const PartShape& shape, double step, const Mat4d& metric) {
  Enlarging out;
  if (!(step > 0)) return out;
  const Mat4d back = metric.inverse3();
  out.any = true;
  out.center = back.direction(shape.center);
  out.map = back * shape.enlarging(step) * metric;
  out.for_normals = transposed3(out.map.inverse3());
  return out;
}

// The move of each part's fastest end. A shape's formula is a lower bound of the area, so for round parts the move that
// it gives is too large. Two corrections by the area that really comes out bring it within a hundredth, as a rule.
std::vector<double> steps_for(const Mesh& mesh, const std::vector<std::uint32_t>& part_of,
                              const std::vector<PartMeasure>& measures, const std::vector<std::uint8_t>& no_prune,
                              const std::vector<double>& area_of_part, double most, const Mat4d& metric) {
  const std::size_t parts = measures.size();
  std::vector<double> steps(parts, 0);
  for (std::size_t p = 0; p < parts; ++p) {
    const PartShape& shape = measures[p].shape();
    const bool grows = no_prune[p] == 0 && area_of_part[p] > kSame * shape.area;
    if (grows && shape.growth_for(area_of_part[p]) <= 2 * most) steps[p] = shape.step_for(area_of_part[p]);
  }
  for (int round = 0; round < 2; ++round) {
    std::vector<Mat4d> maps(parts);
    for (std::size_t p = 0; p < parts; ++p) {
      if (steps[p] > 0) maps[p] = measures[p].shape().enlarging(steps[p]) * metric;
    }
    std::vector<double> area(parts, 0);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const Triangle v = mesh.vertices_of(t);
      const std::uint32_t p = part_of[v[0]];
      if (p == kNone || !(steps[p] > 0)) continue;
      const auto placed = [&](std::uint32_t c) { return maps[p].direction(to_double(mesh.positions[c])); };
      area[p] += length(scaled_normal(placed(v[0]), placed(v[1]), placed(v[2]))) / 2;
    }
    for (std::size_t p = 0; p < parts; ++p) {
      const double gained = area[p] - measures[p].shape().area, wanted = area_of_part[p] - measures[p].shape().area;
      if (steps[p] > 0 && gained > wanted) steps[p] *= wanted / gained;
    }
  }
  for (std::size_t p = 0; p < parts; ++p) {
    if (steps[p] > 0) steps[p] = std::min(steps[p], most / measures[p].shape().reach);
  }
  return steps;
}

// Calls change(values of one wedge, enlarging) for all wedges of a float stream whose part grows.
template <class Change>
void change_stream(AttributeStream& stream, const Mesh& mesh, const std::vector<std::uint32_t>& part_of,
                   const std::vector<Enlarging>& enlargings, const Change& change) {
  auto* values = std::get_if<std::vector<float>>(&stream.values);
  if (values == nullptr || stream.components < 3) return;
  for (std::uint32_t w = 0; w < mesh.wedge_count(); ++w) {
    const std::uint32_t p = part_of[mesh.vertex_of(w)];
    if (p == kNone || !enlargings[p].any) continue;
    float* v = values->data() + std::size_t{w} * stream.components;
    const Vec3f changed = to_float(change(to_double(Vec3f{v[0], v[1], v[2]}), enlargings[p]));
    for (std::size_t k = 0; k < 3; ++k) v[k] = changed[k];
  }
}

}  // namespace

void grow_parts(const Mesh& original, const PruneOrder& order, const GrowTargets& targets,
                const std::vector<std::uint32_t>& origin, Mesh& mesh) {
  const Mat4d& metric = targets.metric;
  if (metric.determinant3() == 0) return;  // drawn flat: the metric has no inverse
  const std::vector<std::uint32_t> part_of = parts_of_vertices(original, order.parts, origin, mesh);
  const std::vector<PartMeasure> measures = measure(mesh, part_of, order.parts.count, metric);
  const std::vector<double> steps =
      steps_for(mesh, part_of, measures, order.no_prune, targets.area_of_part, targets.most, metric);
  std::vector<Enlarging> enlargings(order.parts.count);
  for (std::size_t p = 0; p < enlargings.size(); ++p) enlargings[p] = enlarging(measures[p].shape(), steps[p], metric);
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    const std::uint32_t p = part_of[v];
    if (p == kNone || !enlargings[p].any) continue;
    const Enlarging& e = enlargings[p];
    mesh.positions[v] = to_float(e.center + e.map.direction(to_double(mesh.positions[v]) - e.center));
  }
  for (AttributeStream& stream : mesh.attributes) {
    const auto change = [&](const auto& how) { change_stream(stream, mesh, part_of, enlargings, how); };
    if (stream.semantic == Semantic::normal) {
      change([](Vec3d n, const Enlarging& e) { return normalized(e.for_normals.direction(n)); });
    } else if (stream.semantic == Semantic::tangent) {
      change([](Vec3d t, const Enlarging& e) { return normalized(e.map.direction(t)); });
    } else if (stream.semantic == Semantic::morph_position) {
      change([](Vec3d d, const Enlarging& e) { return e.map.direction(d); });
    }
  }
}

}  // namespace lodestone::simplify
