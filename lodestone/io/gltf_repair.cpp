#include "lodestone/io/gltf_repair_detail.h"

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

void repair_bounds(const Document::Data& data, std::size_t index, Json& accessor) {
  if (!accessor.contains("min") && !accessor.contains("max")) return;
  const Result<Accessor> found = find_accessor(data, index);
  if (!found || found->type != ComponentType::float32 || found->count == 0) return;
  const std::size_t n = found->components;
  std::vector<float> values(found->count * n), low(n, std::numeric_limits<float>::infinity()), high(n);
  std::fill(high.begin(), high.end(), -std::numeric_limits<float>::infinity());
  gather(*found, {}, found->count, values.data(), n, 0, {});
  for (std::size_t i = 0; i < values.size(); ++i) {
    low[i % n] = std::min(low[i % n], values[i]);
    high[i % n] = std::max(high[i % n], values[i]);
  }
  if (accessor.contains("min") && accessor["min"] != Json(low)) accessor["min"] = low;
  if (accessor.contains("max") && accessor["max"] != Json(high)) accessor["max"] = high;
}

}  // namespace

bool normalize_weights(Mesh& mesh) {
  std::vector<AttributeStream*> sets;
  for (AttributeStream& s : mesh.attributes) {
    if (s.semantic == Semantic::weights && std::holds_alternative<std::vector<float>>(s.values)) sets.push_back(&s);
  }
  if (sets.empty()) return false;
  bool changed = false;
  for (std::size_t w = 0; w < mesh.wedge_count(); ++w) {
    double sum = 0;
    for (const AttributeStream* s : sets) {
      const auto& values = std::get<std::vector<float>>(s->values);
      for (std::size_t k = 0; k < s->components; ++k) sum += values[w * s->components + k];
    }
    if (std::abs(sum - 1) <= 1e-3) continue;
    changed = true;
    for (AttributeStream* s : sets) {
      auto& values = std::get<std::vector<float>>(s->values);
      for (std::size_t k = 0; k < s->components; ++k) {
        float& value = values[w * s->components + k];
        value = sum > 0 ? static_cast<float>(value / sum) : (s == sets.front() && k == 0 ? 1.0F : 0.0F);
      }
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

void repair_accessors(const Document::Data& data, Json& json) {
  const std::size_t accessors = array_member(json, "accessors").size(),
                    views = array_member(json, "bufferViews").size();
  for (std::size_t i = 0; i < accessors; ++i) repair_bounds(data, i, json["accessors"][i]);
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
