// From what users say of a model (spheres, a weight attribute, ranges of triangles) to what edge collapse is told of
// each mesh: a weight and a no_move mark for each vertex, and a mark for each triangle that must not change.
//
// vertex_constraints() does this in three steps, after which weights that are 1 everywhere are dropped:
// 1. untouched_triangles() marks all triangles outside of the ranges, numbered over the model's meshes in order.
//    Vertices of marked triangles are no_move (vertices_of_triangles()).
// 2. add_attribute() reads weights from a stream of one component. Of several wedges at a vertex the largest counts.
// 3. add_spheres() places the vertices of every instance in world space. Within spheres the largest of their weights
//    replaces the attribute's; one sphere of no_move is enough to fix a vertex. A mesh that is drawn several times
//    obeys the spheres at all its instances.
// empty_spheres() lists the spheres in which no drawn vertex lies, so that the caller can warn.
//
// Single-threaded, in the order of the input. O(drawn vertices * spheres + triangles).
#include "lodestone/chain/ladder/constraints.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "lodestone/core/validate.h"

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

bool holds(const ConstraintSphere& s, Vec3d p) { return length_sq(p - s.center) <= s.radius * s.radius; }

void add_spheres(const Model& model, std::size_t mesh_index, const std::vector<ConstraintSphere>& spheres,
                 VertexConstraints& out) {
  const Mesh& mesh = model.meshes[mesh_index];
  std::vector<float> inside(mesh.vertex_count(), -1);
  out.no_move.resize(mesh.vertex_count(), 0);
  for (const Instance& instance : model.instances) {
    if (instance.mesh != mesh_index) continue;
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
      const Vec3d p = instance.transform.point(mesh.position(v));
      for (const ConstraintSphere& s : spheres) {
        if (!holds(s, p)) continue;
        if (s.no_move) out.no_move[v] = 1;
        if (!s.no_move) inside[v] = std::max(inside[v], static_cast<float>(std::min(s.weight, 1e30)));
      }
    }
  }
  for (std::size_t v = 0; v < inside.size(); ++v) {
    if (inside[v] >= 0) out.weights[v] = inside[v];
  }
}

}  // namespace

Result<std::vector<VertexConstraints>> vertex_constraints(const Model& model, const SimplifyConstraints& constraints) {
  LODESTONE_TRY(validate(model));
  std::vector<VertexConstraints> out(model.meshes.size());
  const Result<std::vector<std::vector<std::uint8_t>>> untouched = untouched_triangles(model, constraints);
  LODESTONE_TRY(untouched);
  for (std::size_t m = 0; m < untouched->size(); ++m) {
    out[m].no_move = vertices_of_triangles(model.meshes[m], (*untouched)[m]);
  }
  if (constraints.spheres.empty() && constraints.weight_attribute.empty()) return out;
  bool found = constraints.weight_attribute.empty();
  for (std::size_t m = 0; m < model.meshes.size(); ++m) {
    const Mesh& mesh = model.meshes[m];
    out[m].weights.assign(mesh.vertex_count(), 1);
    if (!constraints.weight_attribute.empty()) {
      if (const AttributeStream* stream = weight_stream(mesh, constraints.weight_attribute); stream != nullptr) {
        found = true;
        LODESTONE_TRY(add_attribute(mesh, *stream, out[m].weights));
      }
    }
    if (!constraints.spheres.empty()) add_spheres(model, m, constraints.spheres, out[m]);
    // Where nothing weighs more, there are no weights: levels can be improved as without them.
    const std::vector<float>& weights = out[m].weights;
    if (std::all_of(weights.begin(), weights.end(), [](float w) { return w == 1; })) out[m].weights.clear();
  }
  if (!found) {
    return fail(ErrorCode::bad_argument, fmt::format("no mesh has an attribute '{}'", constraints.weight_attribute), {},
                names_of(model));
  }
  return out;
}

Result<std::vector<std::vector<std::uint8_t>>> untouched_triangles(const Model& model,
                                                                   const SimplifyConstraints& constraints) {
  std::vector<std::vector<std::uint8_t>> out;
  if (constraints.only.empty()) return out;
  std::uint64_t all = 0;
  for (const Mesh& mesh : model.meshes) all += mesh.triangles.size();
  std::vector<std::uint8_t> untouched(static_cast<std::size_t>(all), 1);
  for (const TriangleRange& range : constraints.only) {
    if (range.first > range.last || range.last >= all) {
      return fail(ErrorCode::bad_argument, fmt::format("there are no triangles {} to {}", range.first, range.last), {},
                  fmt::format("the model has {}, counted from 0", all));
    }
    std::fill(untouched.begin() + static_cast<std::ptrdiff_t>(range.first),
              untouched.begin() + static_cast<std::ptrdiff_t>(range.last) + 1, std::uint8_t{0});
  }
  auto next = untouched.begin();
  for (const Mesh& mesh : model.meshes) {
    const auto end = next + static_cast<std::ptrdiff_t>(mesh.triangles.size());
    out.emplace_back(next, end);
    next = end;
  }
  return out;
}

std::vector<std::uint8_t> vertices_of_triangles(const Mesh& mesh, const std::vector<std::uint8_t>& marked) {
  std::vector<std::uint8_t> out;
  if (marked.empty()) return out;
  out.assign(mesh.vertex_count(), 0);
  for (std::size_t t = 0; t < marked.size(); ++t) {
    if (marked[t] == 0) continue;
    for (const std::uint32_t v : mesh.vertices_of(t)) out[v] = 1;
  }
  return out;
}

std::vector<std::size_t> empty_spheres(const Model& model, const std::vector<ConstraintSphere>& spheres) {
  std::vector<std::size_t> empty(spheres.size());
  std::iota(empty.begin(), empty.end(), std::size_t{0});
  for (const Instance& instance : model.instances) {
    const Mesh& mesh = model.meshes[instance.mesh];
    for (std::uint32_t v = 0; v < mesh.vertex_count() && !empty.empty(); ++v) {
      const Vec3d p = instance.transform.point(mesh.position(v));
      std::erase_if(empty, [&](std::size_t s) { return holds(spheres[s], p); });
    }
  }
  return empty;
}

}  // namespace lodestone::chain
