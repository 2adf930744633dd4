// glTF models made in tests: accessors from plain lists, packed into one GLB.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <type_traits>
#include <vector>

namespace lodestone::test {

using Json = nlohmann::ordered_json;

template <class T>
constexpr int component_number() {
  if constexpr (std::is_same_v<T, std::int8_t>) return 5120;
  if constexpr (std::is_same_v<T, std::uint8_t>) return 5121;
  if constexpr (std::is_same_v<T, std::int16_t>) return 5122;
  if constexpr (std::is_same_v<T, std::uint16_t>) return 5123;
  if constexpr (std::is_same_v<T, std::uint32_t>) return 5125;
  return 5126;
}

/// A GLB of these parts.
inline std::string make_glb(const std::string& json, const std::string& bin) {
  const auto word = [](std::size_t n) {
    const auto v = static_cast<std::uint32_t>(n);
    std::string out(4, '\0');
    std::memcpy(out.data(), &v, 4);
    return out;
  };
  std::string text = json;
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::string out = "glTF" + word(2) + word(12 + 8 + text.size() + (bin.empty() ? 0 : 8 + bin.size()));
  out += word(text.size()) + "JSON" + text;
  if (!bin.empty()) out += word(bin.size()) + std::string("BIN\0", 4) + bin;
  return out;
}

struct GltfBuilder {
  Json json = {{"asset", {{"version", "2.0"}}}, {"scene", 0},
               {"scenes", {{{"nodes", {0}}}}},  {"nodes", Json::array()},
               {"meshes", Json::array()},       {"accessors", Json::array()},
               {"bufferViews", Json::array()}};
  std::string bin;

  /// `per` values an element, `stride` bytes apart (0: tight).
  template <class T>
  std::size_t accessor(const std::vector<T>& values, const char* type, std::size_t per, bool normalized = false,
                       std::size_t stride = 0) {
    const std::size_t count = values.size() / per, step = stride == 0 ? per * sizeof(T) : stride, at = bin.size();
    bin.resize((at + step * count + 3) / 4 * 4, '\0');
    for (std::size_t i = 0; i < count; ++i) std::memcpy(bin.data() + at + i * step, &values[i * per], per * sizeof(T));
    Json view = {{"buffer", 0}, {"byteOffset", at}, {"byteLength", step * count}};
    if (stride != 0) view["byteStride"] = stride;
    json["bufferViews"].push_back(view);
    Json out = {{"bufferView", json["bufferViews"].size() - 1},
                {"componentType", component_number<T>()},
                {"count", count},
                {"type", type}};
    if (normalized) out["normalized"] = true;
    json["accessors"].push_back(out);
    return json["accessors"].size() - 1;
  }
  template <class T>
  std::size_t positions(const std::vector<T>& values, bool normalized = false) {
    const std::size_t index = accessor(values, "VEC3", 3, normalized, sizeof(T) == 4 ? 0 : sizeof(T) == 2 ? 8 : 4);
    tell_bounds(index, values, 3);
    return index;
  }
  /// Gives accessor `index` the smallest and largest of `values`.
  template <class T>
  void tell_bounds(std::size_t index, const std::vector<T>& values, std::size_t per) {
    std::vector<T> low(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(per)), high = low;
    for (std::size_t i = 0; i < values.size(); ++i) {
      low[i % per] = std::min(low[i % per], values[i]);
      high[i % per] = std::max(high[i % per], values[i]);
    }
    json["accessors"][index]["min"] = low;
    json["accessors"][index]["max"] = high;
  }
  /// As accessor(), with bounds.
  template <class T>
  std::size_t bounded(const std::vector<T>& values, const char* type, std::size_t per, bool normalized = false) {
    const std::size_t index = accessor(values, type, per, normalized);
    tell_bounds(index, values, per);
    return index;
  }
  std::size_t indices(const std::vector<std::uint16_t>& values) { return accessor(values, "SCALAR", 1); }

  /// A flat sheet of n x n cells at height z as positions and indices; returns its primitive.
  Json sheet(int n, float z) {
    std::vector<float> p;
    std::vector<std::uint16_t> corners;
    for (int y = 0; y <= n; ++y) {
      for (int x = 0; x <= n; ++x) p.insert(p.end(), {static_cast<float>(x), static_cast<float>(y), z});
    }
    for (int y = 0; y < n; ++y) {
      for (int x = 0; x < n; ++x) {
        const int a = y * (n + 1) + x, b = a + 1, c = a + n + 1, d = c + 1;
        for (const int i : {a, b, d, a, d, c}) corners.push_back(static_cast<std::uint16_t>(i));
      }
    }
    return {{"attributes", {{"POSITION", positions(p)}}}, {"indices", indices(corners)}};
  }

  std::string glb() const {
    Json out = json;
    out["buffers"] = {{{"byteLength", bin.size()}}};
    return make_glb(out.dump(), bin);
  }
};

/// A model of one node with one sheet of 3 x 3 cells.
inline GltfBuilder sheet_model() {
  GltfBuilder b;
  b.json["meshes"] = {{{"primitives", {b.sheet(3, 1.5F)}}}};
  b.json["nodes"] = {{{"mesh", 0}}};
  return b;
}

/// JSON and binary chunk of a GLB that was written.
struct GlbContent {
  Json json;
  std::string bin;
};

inline GlbContent open_glb(const std::string& bytes) {
  std::uint32_t json_size = 0, bin_size = 0;
  std::memcpy(&json_size, bytes.data() + 12, 4);
  GlbContent out;
  out.json = Json::parse(bytes.substr(20, json_size));
  const std::size_t at = 20 + json_size;
  if (bytes.size() < at + 8) return out;
  std::memcpy(&bin_size, bytes.data() + at, 4);
  out.bin = bytes.substr(at + 8, bin_size);
  return out;
}

/// The stored numbers of an accessor.
inline std::vector<double> stored_values(const GlbContent& glb, std::size_t index, std::size_t per) {
  const Json& a = glb.json["accessors"][index];
  const Json& view = glb.json["bufferViews"][a["bufferView"].get<std::size_t>()];
  const int type = a["componentType"].get<int>();
  const std::size_t size = type <= 5121 ? 1 : type <= 5123 ? 2 : 4;
  const std::size_t stride = view.value("byteStride", size * per), count = a["count"].get<std::size_t>();
  const char* base = glb.bin.data() + view["byteOffset"].get<std::size_t>() + a.value("byteOffset", std::size_t{0});
  std::vector<double> out;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < per; ++k) {
      const char* at = base + i * stride + k * size;
      const auto as = [&](auto value) {
        std::memcpy(&value, at, sizeof value);
        out.push_back(static_cast<double>(value));
      };
      switch (type) {
        case 5120:
          as(std::int8_t{});
          break;
        case 5121:
          as(std::uint8_t{});
          break;
        case 5122:
          as(std::int16_t{});
          break;
        case 5123:
          as(std::uint16_t{});
          break;
        case 5125:
          as(std::uint32_t{});
          break;
        default:
          as(float{});
      }
    }
  }
  return out;
}

}  // namespace lodestone::test
