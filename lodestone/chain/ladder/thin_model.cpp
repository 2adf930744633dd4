#include "lodestone/chain/ladder/thin_model.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "lodestone/core/parts.h"
#include "lodestone/math/symmetric.h"
#include "lodestone/math/triangle.h"

namespace lodestone::chain {

namespace {

struct PartSums {
  double area = 0;
  double vertices = 0;
  Vec3d sum;
  Symmetric3d squares;  // about the model's centre
};

std::vector<PartSums> sums_of(const Mesh& mesh, const Parts& parts, const Mat4d& placing, Vec3d center) {
  std::vector<PartSums> out(parts.count);
  const auto at = [&](std::uint32_t v) { return placing.point(mesh.position(v)) - center; };
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    if (parts.of_vertex[v] == kNone) continue;
    PartSums& part = out[parts.of_vertex[v]];
    const Vec3d p = at(v);
    part.vertices += 1;
    part.sum += p;
    part.squares.add(p, 1);
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle v = mesh.vertices_of(t);
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) continue;
    out[parts.of_vertex[v[0]]].area += length(scaled_normal(at(v[0]), at(v[1]), at(v[2]))) / 2;
  }
  return out;
}

// The extent along the middle axis: four standard deviations, at least what evenly spread vertices measure.
double width_of(const PartSums& part) {
  if (!(part.vertices > 0)) return 0;
  const Vec3d mean = part.sum / part.vertices;
  Symmetric3d covariance;
  for (std::size_t i = 0; i < 3; ++i) covariance.rows[i] = part.squares.rows[i] / part.vertices;
  covariance.add(mean, -1);
  std::array<double, 3> variance{};
  const std::array<Vec3d, 3> axes = axes_of(covariance);
  for (std::size_t i = 0; i < 3; ++i) variance[i] = std::max(0.0, covariance.form(axes[i]));
  std::sort(variance.begin(), variance.end());
  return 4 * std::sqrt(variance[1]);
}

}  // namespace

ThinShare thin_share(const Model& model, const Task& task) {
  constexpr double kThin = 0.05;
  const Box3d box = bounds_of(model);
  std::vector<Parts> parts(model.meshes.size());
  const std::vector<std::uint32_t> uses = instance_counts(model);
  for (std::size_t m = 0; m < parts.size(); ++m) {
    if (uses[m] > 0) parts[m] = parts_of(model.meshes[m]);
  }
  ThinShare out;
  for (const Instance& instance : model.instances) out.parts += parts[instance.mesh].count;
  if (out.parts < 2) return out;
  double area = 0;
  for (const Instance& instance : model.instances) {
    if (task.cancelled()) return {};
    for (const PartSums& part :
         sums_of(model.meshes[instance.mesh], parts[instance.mesh], instance.transform, box.center())) {
      area += part.area;
      if (width_of(part) <= kThin * box.diagonal()) out.area += part.area;
    }
  }
  out.area = area > 0 ? out.area / area : 0;
  return out;
}

bool needs_keep_area(const ThinShare& share, std::size_t smallest_triangles) {
  constexpr std::size_t kMany = 32, kFewTriangles = 16;
  constexpr double kMost = 0.5;
  return share.parts >= kMany && share.area >= kMost && smallest_triangles < kFewTriangles * share.parts;
}

}  // namespace lodestone::chain
