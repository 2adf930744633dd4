// How levels hang in the nodes of a glTF scene: MSFT_lod, with MSFT_screencoverage.
//
// choose_holder() decides which node carries a mesh's levels: the node itself, or, where it has children, is animated,
// is a joint or has a transform that the format forbids (role_of(), has_odd_transform()), a new leaf that takes over
// mesh, skin and weights. level_node() makes the node of a level, with the holder's transform; it stands outside of the
// scene, named by the holder's extension alone. Weight animations follow the mesh and are repeated for each level that
// still morphs (move_weight_channels(), detach_weight_channels()).
//
// Nodes are only added, never renumbered, so every index in the document still means the same.
#include "lodestone/io/gltf/lod_detail.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "lodestone/math/vec.h"

namespace lodestone::io {

namespace {

struct Columns {
  Vec3d x, y, z;
  bool projects = false;
};

std::optional<Columns> matrix_columns(const Json& node) {
  double m[16];
  const Result<bool> matrix = numbers_member(node, "matrix", m, {});
  if (!matrix || !*matrix) return std::nullopt;
  const bool projects = m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1;
  return Columns{{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}, projects};
}

bool has_odd_rotation(const Json& node) {
  double q[4];
  const Result<bool> rotation = numbers_member(node, "rotation", q, {});
  if (!rotation || !*rotation) return false;
  double sum = 0;
  for (const double c : q) {
    if (std::abs(c) > 1) return true;  // the format has this limit of its own, without any slack
    sum += c * c;
  }
  return std::abs(sum - 1) > 1e-3;
}

// Validators rebuild a matrix from its parts in floats and allow 5e-5 in all: what is large or leans a little may
// fail, and would fail once more at every level.
bool may_fail_checks(const Json& node) {
  const std::optional<Columns> c = matrix_columns(node);
  if (!c) return false;
  const auto leans = [](Vec3d a, Vec3d b) { return std::abs(dot(a, b)) > 2.5e-5 * std::min(length(a), length(b)); };
  const double turned = std::max(
      {std::abs(c->x.y), std::abs(c->x.z), std::abs(c->y.x), std::abs(c->y.z), std::abs(c->z.x), std::abs(c->z.y)});
  const bool large = turned > 0 && std::max({length(c->x), length(c->y), length(c->z)}) > 200;
  return large || leans(c->x, c->y) || leans(c->y, c->z) || leans(c->x, c->z);
}

}  // namespace

bool has_odd_transform(const Json& node) {
  if (has_odd_rotation(node)) return true;
  const std::optional<Columns> c = matrix_columns(node);
  if (!c) return false;
  for (const char* key : {"translation", "rotation", "scale"}) {
    if (node.contains(key)) return true;
  }
  const auto leans = [](Vec3d a, Vec3d b) { return std::abs(dot(a, b)) > 1e-4 * length(a) * length(b); };
  const bool flat = !(std::abs(dot(c->x, cross(c->y, c->z))) > 0);
  return flat || c->projects || leans(c->x, c->y) || leans(c->y, c->z) || leans(c->x, c->z);
}

namespace {

constexpr const char* kTransforms[] = {"matrix", "translation", "rotation", "scale"};

struct NodeRole {
  bool transform_animated = false, joint = false;
};

template <class Use>
void each_channel(Json& json, Use use) {
  if (!json.contains("animations") || !json["animations"].is_array()) return;
  for (Json& animation : json["animations"]) {
    if (!animation.is_object() || !animation.contains("channels") || !animation["channels"].is_array()) continue;
    use(animation["channels"]);
  }
}

bool targets(const Json& channel, std::size_t node, bool weights) {
  const Json* target = member(channel, "target");
  if (target == nullptr) return false;
  const Json* index = member(*target, "node");
  if (index == nullptr || as_uint(*index).value_or(node + 1) != node) return false;
  return (string_member(*target, "path") == "weights") == weights;
}

// KHR_animation_pointer names a node's property by a path.
bool points_at(const Json& channel, std::size_t node) {
  const Json* target = member(channel, "target");
  const Json* extensions = target != nullptr ? member(*target, "extensions") : nullptr;
  const Json* pointer = extensions != nullptr ? member(*extensions, "KHR_animation_pointer") : nullptr;
  return pointer != nullptr && string_member(*pointer, "pointer").starts_with(fmt::format("/nodes/{}/", node));
}

NodeRole role_of(Json& json, std::size_t node) {
  NodeRole role;
  each_channel(json, [&](const Json& channels) {
    for (const Json& c : channels) {
      role.transform_animated = role.transform_animated || targets(c, node, false) || points_at(c, node);
    }
  });
  for (const Json& skin : array_member(json, "skins")) {
    for (const Json& joint : array_member(skin, "joints")) {
      role.joint = role.joint || as_uint(joint).value_or(node + 1) == node;
    }
  }
  return role;
}

// Weight channels follow the mesh to `holder` and are repeated for the levels that still morph.
void move_weight_channels(Json& json, std::size_t from, std::size_t holder, const std::vector<std::size_t>& levels) {
  each_channel(json, [&](Json& channels) {
    const std::size_t count = channels.size();
    for (std::size_t i = 0; i < count; ++i) {
      if (!targets(channels[i], from, true)) continue;
      channels[i]["target"]["node"] = holder;
      for (const std::size_t level : levels) {
        const Json& node = json["nodes"][level];
        const Json* mesh = member(node, "mesh");
        if (mesh == nullptr) continue;
        const Json& primitives = json["meshes"][mesh->get<std::size_t>()]["primitives"];
        if (primitives.empty() || !primitives[0].contains("targets")) continue;
        Json copy = channels[i];
        copy["target"]["node"] = level;
        channels.push_back(std::move(copy));
      }
    }
  });
}

// The node that shall carry the levels: itself, or a new leaf that takes over mesh, skin and weights
// (so that levels don't repeat a transform that the format forbids, either).
std::size_t choose_holder(Json& json, std::size_t node) {
  const NodeRole role = role_of(json, node);
  const Json& carrier = json["nodes"][node];
  const Json* extensions = member(carrier, "extensions");
  const bool light = extensions != nullptr && extensions->contains("KHR_lights_punctual");
  const bool busy = !array_member(carrier, "children").empty() || carrier.contains("camera") || light;
  const bool odd = has_odd_transform(carrier) || may_fail_checks(carrier);
  if (!busy && !role.transform_animated && !role.joint && !odd) return node;
  Json leaf = Json::object();
  const std::string name = string_member(carrier, "name");
  if (!name.empty()) leaf["name"] = name + "_mesh";
  Json& old = json["nodes"][node];
  for (const char* key : {"mesh", "skin", "weights"}) {
    if (!old.contains(key)) continue;
    leaf[key] = old[key];
    old.erase(key);
  }
  if (old.contains("extensions") && old["extensions"].contains(kInstancing)) {
    leaf["extensions"][kInstancing] = old["extensions"][kInstancing];
    old["extensions"].erase(kInstancing);
    if (old["extensions"].empty()) old.erase("extensions");
  }
  if (old.contains("extensions") && old["extensions"].erase(kMsftLod) > 0 && old["extensions"].empty()) {
    old.erase("extensions");  // levels of an earlier run: their mesh has moved
  }
  const std::size_t index = json["nodes"].size();
  old["children"].push_back(index);
  json["nodes"].push_back(std::move(leaf));
  return index;
}

Json level_node(const Json& holder, std::size_t mesh, std::size_t level, const Json& meshes) {
  Json out = Json::object();
  const std::string name = string_member(holder, "name");
  if (!name.empty()) out["name"] = fmt::format("{}_LOD{}", name, level);
  for (const char* key : kTransforms) {
    if (holder.contains(key)) out[key] = holder[key];
  }
  if (mesh == kNone) return out;
  out["mesh"] = mesh;
  if (holder.contains("skin")) out["skin"] = holder["skin"];
  const Json& primitives = meshes[mesh]["primitives"];
  if (holder.contains("weights") && !primitives.empty() && primitives[0].contains("targets")) {
    out["weights"] = holder["weights"];
  }
  const Json* extensions = member(holder, "extensions");
  if (extensions != nullptr && extensions->contains(kInstancing)) {
    out["extensions"][kInstancing] = (*extensions)[kInstancing];
  }
  return out;
}

}  // namespace

NodeLevels add_node_levels(Json& json, std::size_t node, const std::vector<std::size_t>& level_meshes,
                           const std::vector<double>& coverage, std::vector<std::string>& warnings) {
  const std::size_t holder = choose_holder(json, node);
  std::vector<std::size_t> ids;
  for (std::size_t k = 0; k < level_meshes.size(); ++k) {
    Json coarser = level_node(json["nodes"][holder], level_meshes[k], k + 1, json["meshes"]);
    ids.push_back(json["nodes"].size());
    json["nodes"].push_back(std::move(coarser));
  }
  Json& carrier = json["nodes"][holder];
  if (const Json* old = member(carrier, "extensions"); old != nullptr && old->contains(kMsftLod)) {
    warnings.push_back(fmt::format("node {} had levels of its own: replaced by the new ones", node));
  }
  carrier["extensions"][kMsftLod] = {{"ids", ids}};
  if (!coverage.empty()) {
    if (!carrier.contains("extras") || carrier["extras"].is_object()) {
      carrier["extras"][kCoverage] = coverage;
    } else {
      warnings.push_back(fmt::format("node {} has extras that are no object: its screen coverage was left out", node));
    }
  }
  move_weight_channels(json, node, holder, ids);
  return {holder, std::move(ids)};
}

void detach_weight_channels(Json& json, std::size_t node) {
  each_channel(json, [&](Json& channels) {
    for (Json& channel : channels) {
      if (targets(channel, node, true)) channel["target"].erase("node");
    }
  });
}

}  // namespace lodestone::io
