#include "lodestone/io/gltf/names_detail.h"

#include <fmt/format.h>

namespace lodestone::io {

namespace {

void add_names(const Json* attributes, std::set<std::string>& names) {
  if (attributes == nullptr || !attributes->is_object()) return;
  for (const auto& entry : attributes->items()) names.insert(entry.key());
}

void rename(Json& attributes, const std::map<std::string, std::string>& names) {
  if (!attributes.is_object()) return;
  Json out = Json::object();
  for (const auto& entry : attributes.items()) {
    const auto found = names.find(entry.key());
    out[found != names.end() ? found->second : entry.key()] = entry.value();
  }
  attributes = std::move(out);
}

void tell(const std::map<std::string, std::string>& renamed, std::vector<std::string>& warnings) {
  constexpr std::size_t kTold = 10;
  std::size_t count = 0;
  for (const auto& [name, legal] : renamed) {
    if (++count > kTold) break;
    warnings.push_back(fmt::format("attribute '{}' needs an underscore in glTF: named '{}'", name, legal));
  }
  if (renamed.size() <= kTold) return;
  warnings.push_back(fmt::format("{} other attributes got underscores before their names", renamed.size() - kTold));
}

}  // namespace

bool is_legal_attribute(std::string_view name) {
  if (name == "POSITION" || name.starts_with('_')) return true;
  const Semantic semantic = attribute_kind(name, false).semantic;
  return semantic != Semantic::generic && semantic != Semantic::categorical;
}

std::set<std::string> attribute_names(const Json& mesh) {
  std::set<std::string> names;
  for (const Json& primitive : array_member(mesh, "primitives")) {
    add_names(member(primitive, "attributes"), names);
    for (const Json& target : array_member(primitive, "targets")) add_names(&target, names);
    if (is_draco_primitive(primitive)) {
      add_names(member(*member(*member(primitive, "extensions"), kDraco), "attributes"), names);
    }
  }
  return names;
}

std::map<std::string, std::string> legal_names(const std::set<std::string>& names) {
  std::map<std::string, std::string> out;
  for (const std::string& name : names) {
    if (is_legal_attribute(name)) continue;
    std::string legal = "_" + name;
    while (names.contains(legal)) legal.insert(0, "_");
    out.emplace(name, std::move(legal));
  }
  return out;
}

void repair_names(Json& json, std::vector<std::string>& warnings) {
  std::map<std::string, std::string> renamed;
  const std::size_t meshes = array_member(json, "meshes").size();
  for (std::size_t m = 0; m < meshes; ++m) {
    Json& mesh = json["meshes"][m];
    const std::map<std::string, std::string> names = legal_names(attribute_names(mesh));
    if (names.empty()) continue;
    renamed.insert(names.begin(), names.end());
    for (std::size_t p = 0; p < array_member(mesh, "primitives").size(); ++p) {
      Json& primitive = mesh["primitives"][p];
      if (member(primitive, "attributes") == nullptr || is_draco_primitive(primitive)) continue;
      rename(primitive["attributes"], names);
      const std::size_t targets = array_member(primitive, "targets").size();
      for (std::size_t t = 0; t < targets; ++t) rename(primitive["targets"][t], names);
    }
  }
  tell(renamed, warnings);
}

}  // namespace lodestone::io
