// Values that stay as the document has them (primitives of points and lines, meshes that nothing changed) and that the
// specification forbids: skin weights, normals, tangents and colours, put right in the bytes of their views. Points and
// lines are repeated at every level, and so would be what is wrong with them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "lodestone/io/gltf/columns_detail.h"
#include "lodestone/io/gltf/repair_detail.h"

namespace lodestone::io {

namespace {

constexpr double kUnitSlack = 6e-3;     // by how much a vector may miss unit length, as the Khronos validator has it
constexpr double kWeightSlack = 1e-7;   // of a sum, for each weight
constexpr double kWorthTelling = 1e-3;  // less is rounding

// An accessor and where it lies in its view.
struct Location {
  Accessor accessor;
  std::size_t view = 0, offset = 0;
};

class Mender {
 public:
  Mender(const Document::Data& data, MendedViews& views) : data_(data), views_(views) {}

  // The accessor as it is by now: others that share its view may have been mended before. Nothing for accessors whose
  // elements are no plain part of a view: sparse ones, zeros.
  std::optional<Location> place_of(const Json& index) {
    const Json& accessors = array_member(data_.json, "accessors");
    const std::uint64_t a = as_uint(index).value_or(accessors.size());
    if (a >= accessors.size()) return std::nullopt;
    const Json* view = member(accessors[static_cast<std::size_t>(a)], "bufferView");
    Result<Accessor> found = find_accessor(data_, static_cast<std::size_t>(a));
    if (!found || found->own != nullptr || view == nullptr) return std::nullopt;
    Location out{std::move(*found), static_cast<std::size_t>(as_uint(*view).value_or(0)), 0};
    out.offset = static_cast<std::size_t>(out.accessor.data - data_.views[out.view].bytes.data());
    if (const auto mended = views_.find(out.view); mended != views_.end()) {
      out.accessor.data = std::as_bytes(std::span(mended->second)).data() + out.offset;
    }
    return out;
  }

  // All elements; normalised integers divided.
  static std::vector<float> values_of(const Accessor& accessor) {
    std::vector<float> out(accessor.count * accessor.components);
    gather(accessor, {}, accessor.count, out.data(), accessor.components, 0, {});
    return out;
  }

  // False from the second time on: parts that are named again and again cost no more than once.
  bool is_first(std::vector<std::uint64_t> key) { return seen_.insert(std::move(key)).second; }

  void write(const Location& place, std::size_t i, const double* values) {
    const Accessor& a = place.accessor;
    const auto [found, fresh] = views_.try_emplace(place.view);
    if (fresh) {
      const ByteSpan all = data_.views[place.view].bytes;
      found->second.assign(reinterpret_cast<const char*>(all.data()), all.size());
    }
    char* at = found->second.data() + place.offset + i * a.stride;
    for (std::size_t k = 0; k < a.components; ++k)
      store_number(at + k * size_of(a.type), values[k], a.type, a.normalized);
  }

 private:
  const Document::Data& data_;
  MendedViews& views_;
  std::set<std::vector<std::uint64_t>> seen_;
};

// True if anything was wrong.
bool mend_vector(Semantic semantic, std::size_t components, double* v) {
  bool wrong = false;
  for (std::size_t k = 0; k < components; ++k) {
    if (std::isfinite(v[k])) continue;
    v[k] = 0;
    wrong = true;
  }
  if (semantic == Semantic::color) {
    for (std::size_t k = 0; k < components; ++k) {
      wrong = wrong || v[k] < 0 || v[k] > 1;
      v[k] = std::clamp(v[k], 0.0, 1.0);
    }
    return wrong;
  }
  const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  const bool sign = semantic == Semantic::tangent && v[3] != 1 && v[3] != -1;
  if (std::abs(length - 1) <= kUnitSlack && !sign) return wrong;
  for (std::size_t k = 0; k < 3; ++k) v[k] = length > 1e-12 ? v[k] / length : k == 2 ? 1.0 : 0.0;
  if (sign) v[3] = v[3] < 0 ? -1 : 1;
  return true;
}

// One accessor of floats, whoever uses it.
bool mend_vectors(Mender& mender, Semantic semantic, const Json& index) {
  const std::optional<Location> place = mender.place_of(index);
  if (!place || place->accessor.type != ComponentType::float32) return false;
  if (!mender.is_first({place->accessor.index})) return false;
  const std::size_t n = place->accessor.components;
  if (semantic == Semantic::color ? n != 3 && n != 4 : n != (semantic == Semantic::normal ? 3U : 4U)) return false;
  const std::vector<float> values = Mender::values_of(place->accessor);
  bool any = false;
  for (std::size_t i = 0; i < place->accessor.count; ++i) {
    double v[4] = {};
    for (std::size_t k = 0; k < n; ++k) v[k] = static_cast<double>(values[i * n + k]);
    if (!mend_vector(semantic, n, v)) continue;
    mender.write(*place, i, v);
    any = true;
  }
  return any;
}

struct SkinPlaces {
  std::vector<Location> joints, weights;  // by set
};

SkinPlaces find_skin(Mender& mender, const Json& attributes) {
  SkinPlaces out;
  for (std::size_t set = 0;; ++set) {
    const Json* joints = member(attributes, fmt::format("JOINTS_{}", set));
    const Json* weights = member(attributes, fmt::format("WEIGHTS_{}", set));
    if (joints == nullptr || weights == nullptr) return out;
    std::optional<Location> j = mender.place_of(*joints), w = mender.place_of(*weights);
    const auto four = [](const std::optional<Location>& p) { return p && p->accessor.components == 4; };
    if (!four(j) || !four(w) || j->accessor.count != w->accessor.count) return {};
    if (set > 0 &&
        (w->accessor.type != out.weights[0].accessor.type || w->accessor.count != out.weights[0].accessor.count)) {
      return {};
    }
    const bool integer = j->accessor.type == ComponentType::uint8 || j->accessor.type == ComponentType::uint16;
    const bool stored = w->accessor.type == ComponentType::float32 || w->accessor.normalized;
    if (!integer || j->accessor.normalized || !stored) return {};
    out.joints.push_back(std::move(*j));
    out.weights.push_back(std::move(*w));
  }
}

// True if it was worth telling.
bool mend_skin(Mender& mender, const SkinPlaces& skin, std::uint32_t joint_count) {
  const std::size_t sets = skin.weights.size();
  std::vector<std::uint64_t> key{joint_count};
  std::vector<std::vector<float>> stored_weights, stored_joints;
  for (std::size_t s = 0; s < sets; ++s) {
    key.push_back(skin.joints[s].accessor.index);
    key.push_back(skin.weights[s].accessor.index);
  }
  if (sets == 0 || !mender.is_first(std::move(key))) return false;
  for (std::size_t s = 0; s < sets; ++s) {
    stored_weights.push_back(Mender::values_of(skin.weights[s].accessor));
    stored_joints.push_back(Mender::values_of(skin.joints[s].accessor));
  }
  bool telling = false;
  std::vector<double> weights(4 * sets), joints(4 * sets);
  std::vector<std::uint32_t> numbers(4 * sets);
  for (std::size_t i = 0; i < skin.weights[0].accessor.count; ++i) {
    for (std::size_t k = 0; k < weights.size(); ++k) {
      weights[k] = static_cast<double>(stored_weights[k / 4][4 * i + k % 4]);
      joints[k] = static_cast<double>(stored_joints[k / 4][4 * i + k % 4]);
    }
    double sum = 0, used = 0;
    for (std::size_t k = 0; k < weights.size(); ++k) {
      numbers[k] = static_cast<std::uint32_t>(joints[k]);
      sum += weights[k];
      used += weights[k] != 0 ? 1 : 0;
    }
    const bool joints_off = settle_influences(numbers, weights, joint_count);
    if (!joints_off && std::abs(sum - 1) <= kWeightSlack * std::max(used, 1.0)) continue;
    telling = telling || joints_off || std::abs(sum - 1) > kWorthTelling;
    sum_to_one(weights, skin.weights[0].accessor.type);
    for (std::size_t s = 0; s < sets; ++s) {
      mender.write(skin.weights[s], i, weights.data() + 4 * s);
      if (!joints_off) continue;
      for (std::size_t k = 4 * s; k < 4 * s + 4; ++k) joints[k] = numbers[k];
      mender.write(skin.joints[s], i, joints.data() + 4 * s);
    }
  }
  return telling;
}

}  // namespace

bool settle_influences(std::span<std::uint32_t> joints, std::span<double> weights, std::uint32_t joint_count) {
  bool changed = false;
  for (std::size_t k = 0; k < joints.size(); ++k) {
    const bool unknown = joints[k] >= joint_count;
    if (!unknown && weights[k] >= 0 && std::isfinite(weights[k])) continue;
    changed = true;
    weights[k] = 0;
    if (unknown) joints[k] = 0;
  }
  for (std::size_t k = 1; k < joints.size(); ++k) {
    for (std::size_t before = 0; before < k && weights[k] > 0; ++before) {
      if (joints[before] != joints[k] || !(weights[before] > 0)) continue;
      weights[before] += weights[k];
      weights[k] = 0;
      joints[k] = 0;
      changed = true;
    }
  }
  return changed;
}

std::uint32_t joint_count_of(const Json& json, std::size_t mesh) {
  std::uint32_t least = kNone;
  const Json& skins = array_member(json, "skins");
  for (const Json& node : array_member(json, "nodes")) {
    const Json *used = member(node, "mesh"), *skin = member(node, "skin");
    if (used == nullptr || skin == nullptr || as_uint(*used) != std::optional<std::uint64_t>(mesh)) continue;
    const std::uint64_t s = as_uint(*skin).value_or(skins.size());
    if (s >= skins.size()) continue;
    const std::size_t joints = array_member(skins[static_cast<std::size_t>(s)], "joints").size();
    least = std::min(least, static_cast<std::uint32_t>(joints));
  }
  return least;
}

MendedViews mend_values(const Document::Data& data, const std::vector<bool>& rewritten,
                        std::vector<std::string>& warnings) {
  MendedViews views;
  Mender mender(data, views);
  const Json& meshes = array_member(data.json, "meshes");
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    const std::uint32_t joint_count = joint_count_of(data.json, m);
    bool skins = false, vectors = false;
    for (const Json& primitive : array_member(meshes[m], "primitives")) {
      const Json* attributes = member(primitive, "attributes");
      const bool goes = rewritten[m] && is_triangle_primitive(primitive);
      if (goes || attributes == nullptr || !attributes->is_object() || is_draco_primitive(primitive)) continue;
      skins = mend_skin(mender, find_skin(mender, *attributes), joint_count) || skins;
      for (const auto& [name, index] : attributes->items()) {
        const Semantic semantic = attribute_kind(name, false).semantic;
        const bool known = semantic == Semantic::normal || semantic == Semantic::tangent || semantic == Semantic::color;
        vectors = (known && mend_vectors(mender, semantic, index)) || vectors;
      }
    }
    const std::string name = string_member(meshes[m], "name");
    const std::string called = name.empty() ? fmt::format("mesh {}", m) : name;
    if (skins) warnings.push_back(fmt::format("{}: skin weights were not valid: put right", called));
    if (vectors) warnings.push_back(fmt::format("{}: normals, tangents or colours were not valid: put right", called));
  }
  return views;
}

}  // namespace lodestone::io
