// Taking the levels of an earlier run out of a document, so that rebuilding a ladder does not carry them along.
#include <algorithm>
#include <set>

#include "lodestone/io/gltf_detail.h"
#include "lodestone/io/gltf_pack_detail.h"

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

}  // namespace lodestone::io
