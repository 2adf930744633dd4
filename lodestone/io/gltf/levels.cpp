#include "lodestone/io/gltf/levels.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "lodestone/base/file.h"

namespace lodestone::io {

namespace {

// The JSON text of a glTF or GLB; empty when it is neither.
std::string gltf_text(const std::filesystem::path& path) {
  Result<InputFile> file = InputFile::open(path);
  if (!file) return {};
  std::array<std::byte, 20> head{};
  const Result<std::size_t> got = file->read(head);
  if (!got) return {};
  std::uint64_t size = file->size();
  if (*got == head.size() && std::memcmp(head.data(), "glTF", 4) == 0) {
    std::uint32_t chunk = 0;
    std::memcpy(&chunk, head.data() + 12, sizeof chunk);
    size = std::min<std::uint64_t>(chunk, size - head.size());
  } else if (!file->seek(0)) {
    return {};
  }
  std::string text(static_cast<std::size_t>(size), '\0');
  const Result<std::size_t> read = file->read(std::as_writable_bytes(std::span(text)));
  return read && *read == text.size() ? text : std::string();
}

}  // namespace

std::uint64_t levels_in_file(const std::filesystem::path& path) {
  const nlohmann::ordered_json document = nlohmann::ordered_json::parse(gltf_text(path), nullptr, false);
  if (!document.is_object() || !document.contains("nodes") || !document["nodes"].is_array()) return 1;
  std::uint64_t levels = 1;
  for (const nlohmann::ordered_json& node : document["nodes"]) {
    const nlohmann::ordered_json::json_pointer ids("/extensions/MSFT_lod/ids");
    if (node.is_object() && node.contains(ids) && node[ids].is_array()) {
      levels = std::max<std::uint64_t>(levels, node[ids].size() + 1);
    }
  }
  return levels;
}

}  // namespace lodestone::io
