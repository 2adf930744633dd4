#include "lodestone/io/gltf/pack_detail.h"

#include <algorithm>
#include <cstring>

#include "lodestone/io/gltf/meshopt_detail.h"

namespace lodestone::io {

namespace {
constexpr unsigned kArrayBuffer = 34962, kElementArrayBuffer = 34963;
}

void list_extension(Json& root, const char* key, std::string_view name) {
  if (!lists(root, key, name)) root[key].push_back(std::string(name));
}

void unlist_extension(Json& root, const char* key, std::string_view name) {
  if (!root.contains(key) || !root[key].is_array()) return;
  Json& list = root[key];
  for (std::size_t i = list.size(); i-- > 0;) {
    if (list[i] == name) list.erase(i);
  }
  if (list.empty()) root.erase(key);
}

std::size_t GltfPack::append(std::size_t level, std::string_view bytes) {
  std::string& out = bytes_[level];
  const std::size_t offset = out.size();
  out.append(bytes);
  out.resize((out.size() + 3) / 4 * 4, '\0');
  return offset;
}

std::size_t GltfPack::new_view(Json view) {
  if (!free_.empty()) {
    const std::size_t index = free_.back();
    free_.pop_back();
    json_["bufferViews"][index] = std::move(view);
    return index;
  }
  json_["bufferViews"].push_back(std::move(view));
  return json_["bufferViews"].size() - 1;
}

std::size_t GltfPack::add_vertices(std::size_t level, std::string bytes, std::size_t stride) {
  const std::size_t size = bytes.size();
  Json view{{"buffer", 0}, {"byteOffset", 0}, {"byteLength", size}, {"byteStride", stride}, {"target", kArrayBuffer}};
  const bool meshopt = compression_ == Compression::meshopt;
  std::size_t offset = 0;
  if (meshopt) {
    const std::string coded = encode_meshopt_vertices(std::as_bytes(std::span(bytes)), stride);
    offset = append(level, coded);
    view["extensions"][kMeshopt] = {{"buffer", 0},          {"byteOffset", 0},      {"byteLength", coded.size()},
                                    {"byteStride", stride}, {"mode", "ATTRIBUTES"}, {"count", size / stride}};
  } else {
    offset = append(level, bytes);
  }
  const std::size_t index = new_view(std::move(view));
  places_.push_back({index, level, offset, meshopt});
  return index;
}

std::size_t GltfPack::add_indices(std::size_t level, const std::vector<std::uint32_t>& corners, std::size_t vertices) {
  const bool small = vertices < 65536;
  const std::size_t width = small ? 2 : 4, size = corners.size() * width;
  Json view{{"buffer", 0}, {"byteOffset", 0}, {"byteLength", size}, {"target", kElementArrayBuffer}};
  const bool meshopt = compression_ == Compression::meshopt;
  std::size_t offset = 0;
  if (meshopt) {
    const std::string coded = encode_meshopt_triangles(corners, vertices);
    offset = append(level, coded);
    view["extensions"][kMeshopt] = {{"buffer", 0},         {"byteOffset", 0},     {"byteLength", coded.size()},
                                    {"byteStride", width}, {"mode", "TRIANGLES"}, {"count", corners.size()}};
  } else if (small) {
    std::string bytes(size, '\0');
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const auto c = static_cast<std::uint16_t>(corners[i]);
      std::memcpy(bytes.data() + 2 * i, &c, 2);
    }
    offset = append(level, bytes);
  } else {
    offset = append(level, {reinterpret_cast<const char*>(corners.data()), size});
  }
  const std::size_t index = new_view(std::move(view));
  places_.push_back({index, level, offset, meshopt});
  return index;
}

std::size_t GltfPack::add_bytes(std::size_t level, std::string_view bytes) {
  const std::size_t offset = append(level, bytes);
  const std::size_t index = new_view({{"buffer", 0}, {"byteOffset", 0}, {"byteLength", bytes.size()}});
  places_.push_back({index, level, offset, false});
  return index;
}

void GltfPack::set_view(std::size_t view, std::size_t level, std::string_view bytes) {
  const std::size_t offset = append(level, bytes);
  Json& json = json_["bufferViews"][view];
  json["byteLength"] = bytes.size();
  if (const Json* extensions = member(json, "extensions"); extensions != nullptr && extensions->is_object()) {
    Json kept = Json::object();
    for (const auto& [name, value] : extensions->items()) {
      if (member(value, "buffer") == nullptr) {
        kept[name] = value;
      } else {
        moved_.insert(name);
      }
    }
    json["extensions"] = std::move(kept);
    if (json["extensions"].empty()) json.erase("extensions");
  }
  places_.push_back({view, level, offset, false});
}

std::size_t GltfPack::add_accessor(Json accessor) {
  json_["accessors"].push_back(std::move(accessor));
  return json_["accessors"].size() - 1;
}

const Json* GltfPack::find_accessor_json(const Json* index) const {
  const Json& accessors = array_member(json_, "accessors");
  const std::uint64_t i = index != nullptr ? as_uint(*index).value_or(accessors.size()) : accessors.size();
  return i < accessors.size() ? &accessors[static_cast<std::size_t>(i)] : nullptr;
}

std::string GltfPack::finish() {
  for (const std::size_t view : free_) {  // nobody's: four bytes, so that the indices of the others stay
    json_["bufferViews"][view] = {{"buffer", 0}, {"byteOffset", 0}};
    set_view(view, 0, std::string_view("\0\0\0\0", 4));
  }
  std::vector<std::size_t> base(bytes_.size(), 0);
  std::string all;
  std::size_t total = 0;
  for (const std::string& bytes : bytes_) total += bytes.size();
  all.reserve(total);
  for (const std::string& bytes : bytes_) sizes_.push_back(bytes.size());
  for (std::size_t level = bytes_.size(); level-- > 0;) {
    base[level] = all.size();
    all += bytes_[level];
    std::string().swap(bytes_[level]);
  }
  for (const Location& place : places_) {
    Json& view = json_["bufferViews"][place.view];
    const std::size_t offset = base[place.level] + place.offset;
    if (place.meshopt) {
      view["extensions"][kMeshopt]["byteOffset"] = offset;
      view["buffer"] = 1;
      view["byteOffset"] = fallback_bytes_;
      fallback_bytes_ += (view["byteLength"].get<std::uint64_t>() + 3) / 4 * 4;
    } else {
      view["buffer"] = 0;
      view["byteOffset"] = offset;
    }
  }
  if (json_.contains("bufferViews") && json_["bufferViews"].empty()) json_.erase("bufferViews");
  json_["buffers"] = Json::array({{{"byteLength", all.size()}}});
  if (fallback_bytes_ > 0) {
    json_["buffers"].push_back({{"byteLength", fallback_bytes_}, {"extensions", {{kMeshopt, {{"fallback", true}}}}}});
    list_extension(json_, "extensionsUsed", kMeshopt);
    list_extension(json_, "extensionsRequired", kMeshopt);
  }
  return all;
}

}  // namespace lodestone::io
