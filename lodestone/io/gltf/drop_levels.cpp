// Taking the levels of an earlier run out of a document, so that rebuilding a ladder does not carry them along; or all
// but one of them.
#include <algorithm>
#include <map>
#include <set>

#include "lodestone/io/gltf/gltf_detail.h"
#include "lodestone/io/gltf/lod_detail.h"
#include "lodestone/io/gltf/pack_detail.h"

namespace lodestone::io {

namespace {

using Indices = std::set<std::size_t>;

void add_index(const Json* value, Indices& out) {
  if (value == nullptr) return;
  if (const auto index = as_uint(*value); index) out.insert(static_cast<std::size_t>(*index));
}

void add_all(const Json& list, Indices& out) {
  for (const Json& value : list) add_index(&value, out);
}

// Removes MSFT_lod and its coverages from all nodes; returns the nodes that were named as levels.
Indices unlink_levels(Json& nodes) {
  Indices levels;
  for (Json& node : nodes) {
    if (!node.is_object() || !node.contains("extensions") || !node["extensions"].is_object()) continue;
    Json& extensions = node["extensions"];
    if (!extensions.contains(kMsftLod)) continue;
    add_all(array_member(extensions[kMsftLod], "ids"), levels);
    extensions.erase(kMsftLod);
    if (extensions.empty()) node.erase("extensions");
    if (!node.contains("extras") || !node["extras"].is_object()) continue;
    node["extras"].erase("MSFT_screencoverage");
    if (node["extras"].empty()) node.erase("extras");
  }
  return levels;
}

Indices nodes_in_use(const Json& json) {
  Indices used;
  for (const Json& scene : array_member(json, "scenes")) add_all(array_member(scene, "nodes"), used);
  for (const Json& node : array_member(json, "nodes")) add_all(array_member(node, "children"), used);
  for (const Json& skin : array_member(json, "skins")) {
    add_all(array_member(skin, "joints"), used);
    add_index(member(skin, "skeleton"), used);
  }
  return used;
}

void drop_channels_of(Json& json, std::size_t node) {
  if (!json.contains("animations") || !json["animations"].is_array()) return;
  for (Json& animation : json["animations"]) {
    if (!animation.is_object() || !animation.contains("channels") || !animation["channels"].is_array()) continue;
    Json& channels = animation["channels"];
    for (std::size_t i = channels.size(); i-- > 0;) {
      const Json* target = member(channels[i], "target");
      const Json* at = target != nullptr ? member(*target, "node") : nullptr;
      if (at != nullptr && as_uint(*at) == node) channels.erase(i);
    }
  }
}

void add_accessors_of(const Json& mesh, Indices& accessors, Indices& views) {
  for (const Json& primitive : array_member(mesh, "primitives")) {
    if (const Json* attributes = member(primitive, "attributes"); attributes != nullptr)
      add_all(*attributes, accessors);
    for (const Json& target : array_member(primitive, "targets")) add_all(target, accessors);
    add_index(member(primitive, "indices"), accessors);
    const Json* extensions = member(primitive, "extensions");
    if (const Json* draco = extensions != nullptr ? member(*extensions, kDraco) : nullptr; draco != nullptr) {
      add_index(member(*draco, "bufferView"), views);
    }
  }
}

void add_views_of(const Json& accessor, Indices& views) {
  add_index(member(accessor, "bufferView"), views);
  const Json* sparse = member(accessor, "sparse");
  if (sparse == nullptr) return;
  for (const char* key : {"indices", "values"}) {
    if (const Json* part = member(*sparse, key); part != nullptr) add_index(member(*part, "bufferView"), views);
  }
}

// Removes entries from the end of an array while they are in `gone`, so that no index changes; calls use(entry) first.
template <class Use>
void pop_while(Json& json, const char* key, const Indices& gone, Use use) {
  if (!json.contains(key) || !json[key].is_array()) return;
  Json& list = json[key];
  while (!list.empty() && gone.contains(list.size() - 1)) {
    use(list.back(), list.size() - 1);
    list.erase(list.size() - 1);
  }
}

void subtract(Indices& from, const Indices& what) {
  for (const std::size_t i : what) from.erase(i);
}

}  // namespace

void drop_levels(Json& json) {
  if (!json.is_object() || !json.contains("nodes") || !json["nodes"].is_array()) return;
  Indices gone = unlink_levels(json["nodes"]);
  if (gone.empty()) return;
  subtract(gone, nodes_in_use(json));
  Indices meshes, accessors, views;
  pop_while(json, "nodes", gone, [&](const Json& node, std::size_t index) {
    add_index(member(node, "mesh"), meshes);
    drop_channels_of(json, index);
  });
  Indices still;
  for (const Json& node : json["nodes"]) add_index(member(node, "mesh"), still);
  subtract(meshes, still);
  pop_while(json, "meshes", meshes, [&](const Json& mesh, std::size_t) { add_accessors_of(mesh, accessors, views); });
  still.clear();
  Indices still_views;
  for (const Json& mesh : array_member(json, "meshes")) add_accessors_of(mesh, still, still_views);
  subtract(accessors, still);
  pop_while(json, "accessors", accessors, [&](const Json& accessor, std::size_t) { add_views_of(accessor, views); });
  for (const Json& accessor : array_member(json, "accessors")) add_views_of(accessor, still_views);
  for (const Json& image : array_member(json, "images")) add_index(member(image, "bufferView"), still_views);
  subtract(views, still_views);
  pop_while(json, "bufferViews", views, [](const Json&, std::size_t) {});
  for (const char* key : {"meshes", "accessors", "bufferViews"}) {
    if (json.contains(key) && json[key].empty()) json.erase(key);
  }
  unlist_extension(json, "extensionsUsed", kMsftLod);
}

namespace {

std::optional<std::size_t> index_of(const Json& object, const char* key, std::size_t count) {
  const Json* value = member(object, key);
  const auto index = value != nullptr ? as_uint(*value) : std::nullopt;
  if (!index || *index >= count) return std::nullopt;
  return static_cast<std::size_t>(*index);
}

// MSFT_lod's nodes; empty without.
Json level_ids(const Json& node) {
  const Json* extensions = node.is_object() ? member(node, "extensions") : nullptr;
  const Json* lod = extensions != nullptr ? member(*extensions, kMsftLod) : nullptr;
  return lod != nullptr ? array_member(*lod, "ids") : Json::array();
}

// Meshes of nodes that have no levels: these must stay what they are.
Indices meshes_without_levels(const Json& json) {
  Indices out;
  for (const Json& node : array_member(json, "nodes")) {
    if (level_ids(node).empty()) add_index(member(node, "mesh"), out);
  }
  return out;
}

// Meshes of nodes that have levels, and of these levels.
Indices meshes_of_ladders(const Json& json) {
  const Json& nodes = array_member(json, "nodes");
  const std::size_t meshes = array_member(json, "meshes").size();
  Indices of_nodes, out;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const Json ids = level_ids(nodes[n]);
    add_all(ids, of_nodes);
    if (!ids.empty()) of_nodes.insert(n);
  }
  for (const std::size_t n : of_nodes) {
    const auto mesh = n < nodes.size() ? index_of(nodes[n], "mesh", meshes) : std::nullopt;
    if (mesh) out.insert(*mesh);
  }
  return out;
}

// A node is placed and drawn as its level is. Where one mesh becomes another for all nodes, `moves` says so, and the
// node keeps its index.
void take_level(Json& json, std::size_t node_index, std::size_t level, const Indices& fixed,
                std::map<std::size_t, std::size_t>& moves) {
  const Json ids = level_ids(json["nodes"][node_index]);
  if (ids.empty()) return;
  const auto id = as_uint(ids[std::min(level, ids.size()) - 1]);
  if (!id || *id >= json["nodes"].size() || !json["nodes"][static_cast<std::size_t>(*id)].is_object()) return;
  const Json coarse = json["nodes"][static_cast<std::size_t>(*id)];
  Json& node = json["nodes"][node_index];
  const auto copy = [&](const char* key) {
    node.erase(key);
    if (coarse.contains(key)) node[key] = coarse[key];
  };
  if (array_member(node, "children").empty()) {
    for (const char* key : {"translation", "rotation", "scale", "matrix"}) copy(key);
  }
  copy("skin");
  copy("weights");
  if (!node.contains("weights")) detach_weight_channels(json, node_index);
  const std::size_t meshes = array_member(json, "meshes").size();
  const auto from = index_of(coarse, "mesh", meshes), to = index_of(node, "mesh", meshes);
  const bool meshes_both = from && to && json["meshes"][*from].is_object() && json["meshes"][*to].is_object();
  const bool moved = meshes_both && !fixed.contains(*to) && moves.emplace(*to, *from).first->second == *from;
  if (!moved) copy("mesh");
}

// Accessors that nobody names any more, of `candidates`.
Indices unused_accessors(const Json& json, Indices candidates) {
  Indices used, views;
  for (const Json& mesh : array_member(json, "meshes")) add_accessors_of(mesh, used, views);
  for (const Json& skin : array_member(json, "skins")) add_index(member(skin, "inverseBindMatrices"), used);
  for (const Json& animation : array_member(json, "animations")) {
    for (const Json& sampler : array_member(animation, "samplers")) {
      add_index(member(sampler, "input"), used);
      add_index(member(sampler, "output"), used);
    }
  }
  for (const Json& node : array_member(json, "nodes")) {
    const Json* extensions = member(node, "extensions");
    const Json* instancing = extensions != nullptr ? member(*extensions, kInstancing) : nullptr;
    if (instancing == nullptr) continue;
    if (const Json* attributes = member(*instancing, "attributes"); attributes != nullptr) add_all(*attributes, used);
  }
  subtract(candidates, used);
  return candidates;
}

}  // namespace

std::vector<std::size_t> keep_level(Json& json, std::size_t level) {
  if (!json.is_object() || !json.contains("nodes") || !json["nodes"].is_array()) return {};
  const Indices fixed = meshes_without_levels(json);
  Indices accessors, views;
  for (const std::size_t mesh : meshes_of_ladders(json)) add_accessors_of(json["meshes"][mesh], accessors, views);
  std::map<std::size_t, std::size_t> moves;
  for (std::size_t n = 0; n < json["nodes"].size(); ++n) take_level(json, n, level, fixed, moves);
  for (const auto& [to, from] : moves) {
    Json mesh = json["meshes"][from];
    if (const Json* name = member(json["meshes"][to], "name"); name != nullptr) mesh["name"] = *name;
    json["meshes"][to] = std::move(mesh);
  }
  drop_levels(json);
  const Indices unused = unused_accessors(json, std::move(accessors));
  pop_while(json, "accessors", unused, [&](const Json& accessor, std::size_t) { add_views_of(accessor, views); });
  const std::size_t count = array_member(json, "accessors").size();
  Indices still;
  for (std::size_t i = 0; i < count; ++i) {
    if (!unused.contains(i)) {
      add_views_of(json["accessors"][i], still);
      continue;
    }
    add_views_of(json["accessors"][i], views);
    json["accessors"][i] = {{"componentType", 5126}, {"count", 1}, {"type", "SCALAR"}};  // zeros, without a view
  }
  Indices ignored;
  for (const Json& mesh : array_member(json, "meshes")) add_accessors_of(mesh, ignored, still);
  for (const Json& image : array_member(json, "images")) add_index(member(image, "bufferView"), still);
  subtract(views, still);
  pop_while(json, "bufferViews", views, [](const Json&, std::size_t) {});
  return {views.begin(), views.end()};
}

}  // namespace lodestone::io
