#include "lodestone/core/model.h"

namespace lodestone {

Model make_model(Mesh mesh) {
  Model model;
  Instance instance;
  instance.name = mesh.name;
  model.instances.push_back(std::move(instance));
  model.meshes.push_back(std::move(mesh));
  return model;
}

Model make_model(Mesh mesh, const Model& like) {
  Model model = make_model(std::move(mesh));
  model.meters_per_unit = like.meters_per_unit;
  model.gltf_axes = like.gltf_axes;
  return model;
}

std::size_t drawn_triangles(const Model& model) {
  std::size_t sum = 0;
  for (const Instance& instance : model.instances) sum += model.meshes[instance.mesh].triangles.size();
  return sum;
}

std::vector<std::uint32_t> instance_counts(const Model& model) {
  std::vector<std::uint32_t> counts(model.meshes.size(), 0);
  for (const Instance& instance : model.instances) ++counts[instance.mesh];
  return counts;
}

Box3d bounds_of(const Model& model) {
  Box3d box;
  for (const Instance& instance : model.instances) {
    const Mesh& mesh = model.meshes[instance.mesh];
    if (instance.transform.is_identity()) {
      box.add(bounds_of(mesh));
      continue;
    }
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      for (const std::uint32_t v : mesh.vertices_of(t)) box.add(instance.transform.point(mesh.position(v)));
    }
  }
  return box;
}

}  // namespace lodestone
