// What has to be put right before a glTF is written, so that no level repeats what its input had against glTF 2.0.
//
// repair_accessors(): smallest and largest values where the format asks for them (find_bounded()), and right ones where
// values have been mended (repair_bounds(), with_mended()). repair_skin(): weights of a corner sum to one, over all its
// sets, and name joints that exist. zero_non_finite(): numbers that are none become 0. repair_weights(): as many morph
// weights as targets. list_quantization(): KHR_mesh_quantization where what is stored needs it. release_views(): views
// that nothing names any more.
//
// What changes a value that somebody could see is told by the caller. Only the JSON and our own meshes change, never
// the document that was read. O(values of the accessors concerned).
#include "lodestone/io/gltf/repair_detail.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lodestone::io {

namespace {

std::size_t index_or(const Json* value, std::size_t none) {
  return value == nullptr ? none : static_cast<std::size_t>(as_uint(*value).value_or(none));
}

template <class Use>
void each_primitive_accessor(const Json& primitive, Use use) {
  if (const Json* attributes = member(primitive, "attributes"); attributes != nullptr) {
    for (const Json& a : *attributes) use(a);
  }
  for (const Json& target : array_member(primitive, "targets")) {
    for (const Json& a : target) use(a);
  }
  if (const Json* indices = member(primitive, "indices"); indices != nullptr) use(*indices);
}

template <class Use>
void each_tight_accessor(const Json& json, Use use) {
  for (const Json& skin : array_member(json, "skins")) {
    if (const Json* a = member(skin, "inverseBindMatrices"); a != nullptr) use(*a);
  }
  for (const Json& animation : array_member(json, "animations")) {
    for (const Json& sampler : array_member(animation, "samplers")) {
      for (const char* key : {"input", "output"}) {
        if (const Json* a = member(sampler, key); a != nullptr) use(*a);
      }
    }
  }
}

// Accessors that must tell their smallest and largest values.
std::vector<bool> find_bounded(const Json& json, std::size_t accessors) {
  std::vector<bool> out(accessors, false);
  const auto mark = [&](const Json* value) {
    const std::size_t a = index_or(value, accessors);
    if (a < accessors) out[a] = true;
  };
  for (const Json& mesh : array_member(json, "meshes")) {
    for (const Json& primitive : array_member(mesh, "primitives")) {
      if (const Json* attributes = member(primitive, "attributes"); attributes != nullptr) {
        mark(member(*attributes, "POSITION"));
      }
      for (const Json& target : array_member(primitive, "targets")) mark(member(target, "POSITION"));
    }
  }
  for (const Json& animation : array_member(json, "animations")) {
    for (const Json& sampler : array_member(animation, "samplers")) mark(member(sampler, "input"));
  }
  return out;
}

Json as_stored(const std::vector<float>& values, ComponentType type) {
  Json out = Json::array();
  for (const float v : values) {
    if (type == ComponentType::float32) {
      out.push_back(v);
    } else {
      out.push_back(static_cast<int>(v));
    }
  }
  return out;
}

// False where the values have none that could be told.
bool repair_bounds(const Document::Data& data, std::size_t index, bool needed, Json& accessor) {
  if (!needed && !accessor.contains("min") && !accessor.contains("max")) return true;
  Result<Accessor> found = find_accessor(data, index);
  if (!found || found->type == ComponentType::uint32 || found->count == 0) return false;
  found->normalized = false;  // bounds are told as stored
  const std::size_t n = found->components;
  std::vector<float> values(found->count * n), low(n, std::numeric_limits<float>::infinity()), high(n);
  std::fill(high.begin(), high.end(), -std::numeric_limits<float>::infinity());
  gather(*found, {}, found->count, values.data(), n, 0, {});
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) return false;
    low[i % n] = std::min(low[i % n], values[i]);
    high[i % n] = std::max(high[i % n], values[i]);
  }
  const Json least = as_stored(low, found->type), most = as_stored(high, found->type);
  if ((needed || accessor.contains("min")) && accessor["min"] != least) accessor["min"] = least;
  if ((needed || accessor.contains("max")) && accessor["max"] != most) accessor["max"] = most;
  return true;
}

// As much of the document as finding accessors needs, with the mended bytes in place of its own.
Document::Data with_mended(const Document::Data& data, const MendedViews& mended) {
  Document::Data out;
  out.name = data.name;
  out.file_bytes = data.file_bytes;
  out.json["accessors"] = array_member(data.json, "accessors");
  out.views = data.views;
  for (const auto& [view, bytes] : mended) out.views[view].bytes = std::as_bytes(std::span(bytes));
  return out;
}

struct SkinSet {
  std::vector<std::uint32_t>* joints;
  std::vector<float>* weights;
};

// Sets of four, as glTF has them. `skinned`: the wedges of groups that have them all, empty for all wedges.
std::vector<SkinSet> skin_sets(Mesh& mesh, std::vector<bool>& skinned) {
  std::vector<SkinSet> out;
  std::vector<bool> groups(mesh.groups.size(), true);
  bool everywhere = true;
  for (AttributeStream& w : mesh.attributes) {
    auto* weights = std::get_if<std::vector<float>>(&w.values);
    if (w.semantic != Semantic::weights || w.components != 4 || weights == nullptr) continue;
    const auto j = std::find_if(mesh.attributes.begin(), mesh.attributes.end(), [&](const AttributeStream& s) {
      return s.semantic == Semantic::joints && s.set == w.set && s.components == 4;
    });
    auto* joints = j != mesh.attributes.end() ? std::get_if<std::vector<std::uint32_t>>(&j->values) : nullptr;
    if (joints == nullptr) continue;
    out.push_back({joints, weights});
    everywhere = everywhere && w.present.empty();
    for (std::size_t g = 0; g < groups.size() && out.size() == 1; ++g) groups[g] = w.in_group(g);
  }
  if (everywhere || out.empty()) return out;
  skinned.assign(mesh.wedge_count(), false);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::size_t g = mesh.group_of(t);
    if (g >= groups.size() || !groups[g]) continue;
    for (const std::uint32_t w : mesh.triangles[t]) skinned[w] = true;
  }
  return out;
}

}  // namespace

bool repair_skin(Mesh& mesh, std::uint32_t joint_count) {
  std::vector<bool> skinned;
  const std::vector<SkinSet> sets = skin_sets(mesh, skinned);
  bool changed = false;
  std::vector<double> weights(4 * sets.size());
  std::vector<std::uint32_t> joints(weights.size());
  for (std::size_t wedge = 0; wedge < mesh.wedge_count() && !sets.empty(); ++wedge) {
    if (!skinned.empty() && !skinned[wedge]) continue;
    for (std::size_t k = 0; k < weights.size(); ++k) {
      weights[k] = static_cast<double>((*sets[k / 4].weights)[4 * wedge + k % 4]);
      joints[k] = (*sets[k / 4].joints)[4 * wedge + k % 4];
    }
    const bool settled = settle_influences(joints, weights, joint_count);
    double sum = 0;
    for (const double w : weights) sum += w;
    if (!settled && std::abs(sum - 1) <= 1e-3) continue;
    changed = true;
    for (std::size_t k = 0; k < weights.size(); ++k) {
      const double alone = k == 0 ? 1 : 0;
      (*sets[k / 4].weights)[4 * wedge + k % 4] = static_cast<float>(sum > 0 ? weights[k] / sum : alone);
      (*sets[k / 4].joints)[4 * wedge + k % 4] = joints[k];
    }
  }
  return changed;
}

std::uint64_t zero_non_finite(Mesh& mesh) {
  std::uint64_t count = 0;
  for (AttributeStream& stream : mesh.attributes) {
    auto* values = std::get_if<std::vector<float>>(&stream.values);
    if (values == nullptr) continue;
    for (float& value : *values) {
      if (std::isfinite(value)) continue;
      value = 0;
      ++count;
    }
  }
  return count;
}

void repair_accessors(const Document::Data& data, const MendedViews& mended, Json& json) {
  const std::size_t accessors = array_member(json, "accessors").size(),
                    views = array_member(json, "bufferViews").size();
  const std::vector<bool> bounded = find_bounded(json, accessors);
  const Document::Data now = with_mended(data, mended);
  for (std::size_t i = 0; i < accessors; ++i) {
    Json& accessor = json["accessors"][i];
    const bool known = repair_bounds(now, i, bounded[i], accessor);
    if (known || bounded[i] || !mended.contains(index_or(member(accessor, "bufferView"), views))) continue;
    for (const char* key : {"min", "max"}) accessor.erase(key);  // those of bytes that are no more
  }
  each_tight_accessor(json, [&](const Json& value) {
    const std::size_t a = index_or(&value, accessors);
    if (a >= accessors) return;
    const Json& accessor = json["accessors"][a];
    const std::size_t v = index_or(member(accessor, "bufferView"), views);
    if (v >= views || !json["bufferViews"][v].contains("byteStride")) return;
    const Result<Accessor> found = find_accessor(data, a);
    if (!found) return;
    const bool tight = found->stride == found->components * size_of(found->type);
    if (tight) json["bufferViews"][v].erase("byteStride");
  });
}

namespace {

// As many as there are targets.
void fit_weights(Json& holder, std::size_t targets) {
  if (member(holder, "weights") == nullptr) return;
  Json& weights = holder["weights"];
  if (!weights.is_array() || weights.size() == targets) return;
  Json fitting = Json::array();
  for (std::size_t t = 0; t < targets; ++t) fitting.push_back(t < weights.size() ? weights[t] : Json(0));
  weights = std::move(fitting);
  if (targets == 0) holder.erase("weights");
}

std::size_t target_count(const Json& mesh) {
  const Json& primitives = array_member(mesh, "primitives");
  return primitives.empty() ? 0 : array_member(primitives[0], "targets").size();
}

}  // namespace

void repair_weights(Json& json) {
  const std::size_t meshes = array_member(json, "meshes").size();
  for (std::size_t m = 0; m < meshes; ++m) {
    Json& mesh = json["meshes"][m];
    fit_weights(mesh, target_count(mesh));
  }
  for (std::size_t n = 0; n < array_member(json, "nodes").size(); ++n) {
    Json& node = json["nodes"][n];
    const std::size_t m = index_or(member(node, "mesh"), meshes);
    if (m < meshes) fit_weights(node, target_count(json["meshes"][m]));
  }
}

namespace {

// Of what KHR_mesh_quantization allows, the part that glTF alone does not.
bool is_quantized(const std::string& name, bool morph, const Json& accessor) {
  const Json* number = member(accessor, "componentType");
  const std::uint64_t type = number != nullptr ? as_uint(*number).value_or(0) : 0;
  if (type < 5120 || type > 5123) return false;
  if (name == "POSITION") return true;
  const Semantic semantic = attribute_kind(name, morph).semantic;
  const Json* normalized = member(accessor, "normalized");
  const bool is_normalized = normalized != nullptr && *normalized == true;
  if (semantic == Semantic::uv) return type == 5120 || type == 5122 || !is_normalized;
  return semantic == Semantic::normal || semantic == Semantic::tangent || semantic == Semantic::morph_normal ||
         semantic == Semantic::morph_tangent;
}

}  // namespace

void list_quantization(Json& json) {
  const Json& accessors = array_member(json, "accessors");
  bool quantized = false;
  const auto look = [&](const Json& attributes, bool morph) {
    for (const auto& [name, value] : attributes.items()) {
      const std::size_t a = index_or(&value, accessors.size());
      quantized = quantized || (a < accessors.size() && is_quantized(name, morph, accessors[a]));
    }
  };
  for (const Json& mesh : array_member(json, "meshes")) {
    for (const Json& primitive : array_member(mesh, "primitives")) {
      if (const Json* attributes = member(primitive, "attributes"); attributes != nullptr) look(*attributes, false);
      for (const Json& target : array_member(primitive, "targets")) look(target, true);
    }
  }
  if (!quantized) return;
  list_extension(json, "extensionsUsed", "KHR_mesh_quantization");
  list_extension(json, "extensionsRequired", "KHR_mesh_quantization");
}

std::vector<bool> release_views(const Document::Data& data, const std::vector<bool>& rewritten, Json& json) {
  const std::size_t accessors = array_member(json, "accessors").size(), views = data.views.size();
  std::vector<bool> by_rewritten(accessors, false), by_others(accessors, false);
  const auto mark = [&](std::vector<bool>& marks, const Json& value) {
    const std::size_t a = index_or(&value, accessors);
    if (a < accessors) marks[a] = true;
  };
  std::vector<bool> free_views(views, false), used_views(views, false);
  const Json& meshes = array_member(data.json, "meshes");
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    for (const Json& primitive : array_member(meshes[m], "primitives")) {
      const bool goes = rewritten[m] && is_triangle_primitive(primitive);
      each_primitive_accessor(primitive, [&](const Json& value) { mark(goes ? by_rewritten : by_others, value); });
      if (!is_draco_primitive(primitive)) continue;
      const std::size_t v = index_or(member(*member(*member(primitive, "extensions"), kDraco), "bufferView"), views);
      if (v < views) (goes ? free_views : used_views)[v] = true;
    }
  }
  each_tight_accessor(data.json, [&](const Json& value) { mark(by_others, value); });
  for (const Json& node : array_member(data.json, "nodes")) {
    const Json* extensions = member(node, "extensions");
    const Json* instancing = extensions != nullptr ? member(*extensions, kInstancing) : nullptr;
    const Json* attributes = instancing != nullptr ? member(*instancing, "attributes") : nullptr;
    if (attributes == nullptr) continue;
    for (const Json& value : *attributes) mark(by_others, value);
  }
  for (std::size_t a = 0; a < accessors; ++a) {
    Json& accessor = json["accessors"][a];
    const bool goes = by_rewritten[a] && !by_others[a];
    std::vector<std::size_t> names{index_or(member(accessor, "bufferView"), views)};
    if (const Json* sparse = member(accessor, "sparse"); sparse != nullptr) {
      for (const char* key : {"indices", "values"}) {
        if (const Json* part = member(*sparse, key); part != nullptr)
          names.push_back(index_or(member(*part, "bufferView"), views));
      }
    }
    for (const std::size_t v : names) {
      if (v < views) (goes ? free_views : used_views)[v] = true;
    }
    if (!goes) continue;
    for (const char* key : {"bufferView", "byteOffset", "sparse", "min", "max"}) accessor.erase(key);
  }
  for (const Json& image : array_member(data.json, "images")) {
    const std::size_t v = index_or(member(image, "bufferView"), views);
    if (v < views) used_views[v] = true;
  }
  for (std::size_t v = 0; v < views; ++v) free_views[v] = free_views[v] && !used_views[v];
  return free_views;
}

}  // namespace lodestone::io
