#include "lodestone/chain/influence.h"

#include <fmt/format.h>

#include <algorithm>

namespace lodestone::chain {

namespace {

const AttributeStream* weight_stream(const Mesh& mesh, const std::string& name) {
  const auto found = std::find_if(mesh.attributes.begin(), mesh.attributes.end(), [&](const AttributeStream& s) {
    return s.components == 1 && (s.name == name || s.name == "_" + name);
  });
  return found == mesh.attributes.end() ? nullptr : &*found;
}

double value_at(const AttributeStream& stream, std::size_t wedge) {
  return std::visit([&](const auto& values) { return static_cast<double>(values[wedge]); }, stream.values);
}

std::string names_of(const Model& model) {
  std::vector<std::string> names;
  for (const Mesh& mesh : model.meshes) {
    for (const AttributeStream& s : mesh.attributes) {
      if (s.components == 1 && std::find(names.begin(), names.end(), s.name) == names.end()) names.push_back(s.name);
    }
  }
  return names.empty() ? "the model has no attribute of one component"
                       : fmt::format("these have one component: {}", fmt::join(names, ", "));
}

// Of several wedges at a vertex the largest value counts.
Result<void> add_attribute(const Mesh& mesh, const AttributeStream& stream, std::vector<float>& weights) {
  std::vector<float> most(mesh.vertex_count(), 0);
  for (std::uint32_t w = 0; w < mesh.wedge_count(); ++w) {
    const double value = value_at(stream, w);
    if (!(value >= 0)) {
      return fail(ErrorCode::bad_argument, fmt::format("attribute '{}' holds {}", stream.name, value), mesh.name,
                  "weights are 0 or more");
    }
    float& at = most[mesh.vertex_of(w)];
    at = std::max(at, static_cast<float>(std::min(value, 1e30)));
  }
  weights = std::move(most);
  return {};
}

void add_spheres(const Model& model, std::size_t mesh_index, const std::vector<InfluenceSphere>& spheres,
                 VertexInfluence& out) {
  const Mesh& mesh = model.meshes[mesh_index];
  std::vector<float> inside(mesh.vertex_count(), -1);
  out.locked.resize(mesh.vertex_count(), 0);
  for (const Instance& instance : model.instances) {
    if (instance.mesh != mesh_index) continue;
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
      const Vec3d p = instance.transform.point(mesh.position(v));
      for (const InfluenceSphere& s : spheres) {
        if (!(length_sq(p - s.center) <= s.radius * s.radius)) continue;
        if (s.locked) out.locked[v] = 1;
        if (!s.locked) inside[v] = std::max(inside[v], static_cast<float>(std::min(s.weight, 1e30)));
      }
    }
  }
  for (std::size_t v = 0; v < inside.size(); ++v) {
    if (inside[v] >= 0) out.weights[v] = inside[v];
  }
}

}  // namespace

Result<std::vector<VertexInfluence>> vertex_influences(const Model& model, const Influence& influence) {
  std::vector<VertexInfluence> out(model.meshes.size());
  if (!influence.weighs()) return out;
  bool found = influence.weight_attribute.empty();
  for (std::size_t m = 0; m < model.meshes.size(); ++m) {
    const Mesh& mesh = model.meshes[m];
    out[m].weights.assign(mesh.vertex_count(), 1);
    if (!influence.weight_attribute.empty()) {
      if (const AttributeStream* stream = weight_stream(mesh, influence.weight_attribute); stream != nullptr) {
        found = true;
        if (const Result<void> ok = add_attribute(mesh, *stream, out[m].weights); !ok) return fail(ok.error());
      }
    }
    if (!influence.spheres.empty()) add_spheres(model, m, influence.spheres, out[m]);
  }
  if (!found) {
    return fail(ErrorCode::bad_argument, fmt::format("no mesh has an attribute '{}'", influence.weight_attribute), {},
                names_of(model));
  }
  return out;
}

}  // namespace lodestone::chain
