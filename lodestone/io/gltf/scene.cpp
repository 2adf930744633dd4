// The scene: nodes that draw a mesh become instances, with their transforms multiplied out in double.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "lodestone/io/gltf/gltf_detail.h"

namespace lodestone::io {

namespace {

Result<Mat4d> local_transform(const Json& node, const std::string& where) {
  Mat4d matrix;
  const Result<bool> has_matrix = numbers_member(node, "matrix", matrix.m, where);
  LODESTONE_TRY(has_matrix);
  if (*has_matrix) return matrix;
  std::array<double, 3> t{0, 0, 0}, s{1, 1, 1};
  std::array<double, 4> r{0, 0, 0, 1};
  if (const auto ok = numbers_member(node, "translation", t, where); !ok) return fail(ok.error());
  if (const auto ok = numbers_member(node, "rotation", r, where); !ok) return fail(ok.error());
  if (const auto ok = numbers_member(node, "scale", s, where); !ok) return fail(ok.error());
  const double length = std::sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2] + r[3] * r[3]);
  if (length > 0) {
    for (double& x : r) x /= length;
  }
  return Mat4d::translation({t[0], t[1], t[2]}) * Mat4d::rotation(r[0], r[1], r[2], r[3]) *
         Mat4d::scale({s[0], s[1], s[2]});
}

// Transforms of EXT_mesh_gpu_instancing, one identity for a node without it.
Result<std::vector<Mat4d>> instancing(const Document::Data& data, const Json& node, const std::string& where,
                                      Budget& budget) {
  const Json* extensions = member(node, "extensions");
  const Json* extension = extensions != nullptr ? member(*extensions, kInstancing) : nullptr;
  const Json* attributes = extension != nullptr ? member(*extension, "attributes") : nullptr;
  if (attributes == nullptr) return std::vector<Mat4d>{Mat4d{}};
  struct Part {
    const char* name;
    std::size_t components;
    std::vector<float> values;
  };
  std::array<Part, 3> parts{{{"TRANSLATION", 3, {}}, {"ROTATION", 4, {}}, {"SCALE", 3, {}}}};
  std::size_t count = 0;
  for (Part& part : parts) {
    if (member(*attributes, part.name) == nullptr) continue;
    const Result<std::size_t> index =
        index_member(*attributes, part.name, array_member(data.json, "accessors").size(), "accessors", where);
    LODESTONE_TRY(index);
    const Result<Accessor> accessor = find_accessor(data, *index, &budget);
    LODESTONE_TRY(accessor);
    const bool fits = accessor->components == part.components && (count == 0 || accessor->count == count);
    if (!fits) return fail(ErrorCode::bad_format, "its instances have attributes that do not fit together", where);
    count = accessor->count;
    part.values.resize(count * part.components);
    gather(*accessor, {}, count, part.values.data(), part.components, 0, {});
  }
  if (!budget.take(count * (sizeof(Mat4d) + 10 * sizeof(float)))) return unfolds_too_far(data, "the instances", where);
  std::vector<Mat4d> out(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto at = [&](std::size_t p, std::size_t k) {
      return static_cast<double>(parts[p].values[i * parts[p].components + k]);
    };
    if (!parts[0].values.empty()) out[i] = out[i] * Mat4d::translation({at(0, 0), at(0, 1), at(0, 2)});
    if (!parts[1].values.empty()) out[i] = out[i] * Mat4d::rotation(at(1, 0), at(1, 1), at(1, 2), at(1, 3));
    if (!parts[2].values.empty()) out[i] = out[i] * Mat4d::scale({at(2, 0), at(2, 1), at(2, 2)});
  }
  return out;
}

// Depth first without recursion; a node met twice makes the graph no tree.
class SceneWalk {
 public:
  SceneWalk(Document::Data& data, Model& model, Budget& budget, std::size_t draw_level)
      : data_(data),
        model_(model),
        budget_(budget),
        draw_level_(draw_level),
        nodes_(array_member(data.json, "nodes")),
        seen_(nodes_.size(), false) {}

  Result<void> walk(const std::vector<std::size_t>& roots) {
    for (auto root = roots.rbegin(); root != roots.rend(); ++root) stack_.push_back({*root, Mat4d{}});
    while (!stack_.empty()) {
      const Visit visit = stack_.back();
      stack_.pop_back();
      LODESTONE_TRY(enter(visit.node, visit.parent));
    }
    return {};
  }

 private:
  struct Visit {
    std::size_t node;
    Mat4d parent;
  };

  Result<void> enter(std::size_t index, const Mat4d& parent) {
    const std::string where = place(data_, "node", index);
    if (seen_[index]) {
      return fail(ErrorCode::bad_format, "is reached twice: the nodes form a cycle or share a child", where,
                  "export the model again");
    }
    seen_[index] = true;
    const Json& node = level_of(nodes_[index]);
    const Result<Mat4d> local = local_transform(node, where);
    LODESTONE_TRY(local);
    const Mat4d world = parent * *local;
    if (member(node, "mesh") != nullptr) {
      const Result<std::size_t> mesh = index_member(node, "mesh", model_.meshes.size(), "meshes", where);
      LODESTONE_TRY(mesh);
      const Result<std::vector<Mat4d>> placings = instancing(data_, node, where, budget_);
      LODESTONE_TRY(placings);
      if (!model_.meshes[*mesh].triangles.empty()) {
        const std::string name = string_member(nodes_[index], "name");
        const std::uint64_t each = sizeof(Instance) + name.size();
        if (!budget_.take(placings->size() * each)) return unfolds_too_far(data_, "the instances", where);
        for (const Mat4d& placing : *placings) {
          Instance instance;
          instance.mesh = static_cast<std::uint32_t>(*mesh);
          instance.transform = world * placing;
          instance.name = name;
          model_.instances.push_back(std::move(instance));
          data_.instance_nodes.push_back(index);
        }
      }
    }
    const Json& children = array_member(node, "children");
    for (std::size_t i = children.size(); i-- > 0;) {
      const auto child = as_uint(children[i]);
      if (!child || *child >= nodes_.size()) {
        return fail(ErrorCode::bad_format, "names a child that is not there", where, "export the model again");
      }
      stack_.push_back({static_cast<std::size_t>(*child), world});
    }
    return {};
  }

  // The node that stands for this one and its children at the level to be drawn, with its own transform under the same
  // parent.
  const Json& level_of(const Json& node) const {
    const Json* extensions = draw_level_ > 0 ? member(node, "extensions") : nullptr;
    const Json* lod = extensions != nullptr ? member(*extensions, kMsftLod) : nullptr;
    if (lod == nullptr) return node;
    const Json& ids = array_member(*lod, "ids");
    if (ids.empty()) return node;
    const auto id = as_uint(ids[std::min(draw_level_, ids.size()) - 1]);
    return id && *id < nodes_.size() ? nodes_[static_cast<std::size_t>(*id)] : node;
  }

  Document::Data& data_;
  Model& model_;
  Budget& budget_;
  std::size_t draw_level_;
  const Json& nodes_;
  std::vector<bool> seen_;
  std::vector<Visit> stack_;
};

// Roots of the default scene, else of the first, else all nodes that are nobody's child.
Result<std::vector<std::size_t>> find_roots(const Document::Data& data) {
  const Json& scenes = array_member(data.json, "scenes");
  const Json& nodes = array_member(data.json, "nodes");
  std::vector<std::size_t> roots;
  if (!scenes.empty()) {
    Result<std::uint64_t> scene = uint_member(data.json, "scene", 0, data.name);
    LODESTONE_TRY(scene);
    if (*scene >= scenes.size()) {
      return fail(ErrorCode::bad_format, fmt::format("the default scene is {}, there are {}", *scene, scenes.size()),
                  data.name);
    }
    for (const Json& root : array_member(scenes[static_cast<std::size_t>(*scene)], "nodes")) {
      const auto index = as_uint(root);
      if (!index || *index >= nodes.size()) {
        return fail(ErrorCode::bad_format, "the scene names a node that is not there", data.name);
      }
      roots.push_back(static_cast<std::size_t>(*index));
    }
    return roots;
  }
  std::vector<bool> is_child(nodes.size(), false);
  for (const Json& node : nodes) {
    for (const Json& child : array_member(node, "children")) {
      if (const auto index = as_uint(child); index && *index < nodes.size())
        is_child[static_cast<std::size_t>(*index)] = true;
    }
  }
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!is_child[i]) roots.push_back(i);
  }
  if (roots.empty() && !nodes.empty()) {
    return fail(ErrorCode::bad_format, "every node is another's child: the nodes form a cycle", data.name,
                "export the model again");
  }
  return roots;
}

}  // namespace

Result<void> read_scene(Document::Data& data, Model& model, Budget& budget, std::size_t draw_level) {
  const Result<std::vector<std::size_t>> roots = find_roots(data);
  LODESTONE_TRY(roots);
  return SceneWalk(data, model, budget, draw_level).walk(*roots);
}

}  // namespace lodestone::io
