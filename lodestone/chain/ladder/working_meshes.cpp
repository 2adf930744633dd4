#include "lodestone/chain/ladder/working_meshes_detail.h"
#include "lodestone/core/weld.h"
#include "lodestone/spatial/join.h"
#include "lodestone/spatial/snap.h"

namespace lodestone::chain::detail {

std::vector<Mat4d> largest_placings(const Model& model) {
  std::vector<Mat4d> placings(model.meshes.size());
  std::vector<double> scales(model.meshes.size(), 0);
  for (const Instance& i : model.instances) {
    const double scale = i.transform.scale_bound();
    if (scale <= scales[i.mesh]) continue;
    scales[i.mesh] = scale;
    placings[i.mesh] = i.transform.linear();
  }
  return placings;
}

namespace {

// Near vertices get one position, which exact welding then makes one vertex.
template <class Snap>
Result<void> weld_after(Mesh& mesh, const Snap& snap, const Task& task) {
  const Result<std::size_t> moved = snap(mesh);
  LODESTONE_TRY(moved);
  Result<Mesh> welded = weld_exact(std::move(mesh), task);
  LODESTONE_TRY(welded);
  mesh = std::move(*welded);
  return {};
}

}  // namespace

Result<std::vector<Mesh>> working_meshes(const Model& model, const std::vector<Mat4d>& placings,
                                         const SimplifyConstraints& constraints,
                                         const std::vector<std::vector<std::uint8_t>>& untouched, const Task& task) {
  std::vector<Mesh> out;
  if (!(constraints.weld_tolerance > 0) && !(constraints.join_length > 0)) return out;
  out = model.meshes;
  for (std::size_t m = 0; m < out.size(); ++m) {
    // A length in the scene is smaller in a mesh that is drawn larger.
    const double scale = placings[m].scale_bound() > 0 ? placings[m].scale_bound() : 1;
    const std::vector<std::uint8_t>& unchanging = untouched.empty() ? std::vector<std::uint8_t>{} : untouched[m];
    Result<void> done;
    if (constraints.weld_tolerance > 0) {
      const auto snap = [&](Mesh& mesh) {
        return spatial::snap_positions(mesh.positions, constraints.weld_tolerance / scale,
                                       vertices_of_triangles(mesh, unchanging), task);
      };
      done = weld_after(out[m], snap, task);
    }
    if (done && constraints.join_length > 0) {
      const auto snap = [&](Mesh& mesh) {
        return spatial::join_parts(mesh, constraints.join_length / scale, vertices_of_triangles(mesh, unchanging),
                                   task);
      };
      done = weld_after(out[m], snap, task);
    }
    LODESTONE_TRY(done);
  }
  return out;
}

}  // namespace lodestone::chain::detail
