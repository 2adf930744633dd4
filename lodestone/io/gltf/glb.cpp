// The GLB container: a 12-byte header, a JSON chunk, then at most one binary chunk that glTF knows.
#include <fmt/format.h>

#include <cstring>

#include "lodestone/base/units.h"
#include "lodestone/io/gltf/gltf_detail.h"

namespace lodestone::io {

namespace {

constexpr std::uint32_t kJsonChunk = 0x4e4f534a;  // "JSON"
constexpr std::uint32_t kBinChunk = 0x004e4942;   // "BIN\0"

std::uint32_t load_u32(std::string_view bytes, std::size_t at) {
  std::uint32_t value;  // little-endian, as all machines that we build for
  std::memcpy(&value, bytes.data() + at, 4);
  return value;
}

}  // namespace

bool is_glb(std::string_view bytes) { return bytes.substr(0, 4) == "glTF"; }

Result<GlbParts> split_glb(std::string_view bytes, const std::string& where, std::vector<std::string>& warnings) {
  const auto bad = [&](std::string what, std::string remedy = "is it cut off?") {
    return fail(ErrorCode::bad_format, std::move(what), where, std::move(remedy));
  };
  if (bytes.size() < 20) return bad(fmt::format("{} bytes are too few for a GLB header and chunk", bytes.size()));
  const std::uint32_t version = load_u32(bytes, 4), length = load_u32(bytes, 8);
  if (version != 2) {
    return fail(ErrorCode::unsupported, fmt::format("GLB version {}, only 2 is read", version), where,
                "export it again as glTF 2.0");
  }
  if (length > bytes.size()) {
    return bad(fmt::format("the header says {} bytes, the file has {}", length, bytes.size()));
  }
  if (length < 20) return bad(fmt::format("the header says {} bytes, fewer than a header and a chunk", length));
  if (length < bytes.size()) {
    warnings.push_back(fmt::format("{} bytes after the end of the GLB were ignored", bytes.size() - length));
    bytes = bytes.substr(0, length);
  }
  GlbParts parts;
  bool has_json = false, has_bin = false;
  for (std::size_t at = 12; at + 8 <= bytes.size();) {
    const std::uint32_t size = load_u32(bytes, at), type = load_u32(bytes, at + 4);
    if (size > bytes.size() - at - 8) {
      return bad(fmt::format("the chunk at byte {} says {} bytes, {} are left", at, size, bytes.size() - at - 8));
    }
    const std::string_view chunk = bytes.substr(at + 8, size);
    if (!has_json) {
      if (type != kJsonChunk) return bad("the first chunk is not JSON", "is it a GLB 2.0 file?");
      parts.json = chunk;
      has_json = true;
    } else if (type == kBinChunk && !has_bin) {
      parts.bin = chunk;
      has_bin = true;
    } else {
      warnings.push_back(fmt::format("an unknown GLB chunk at byte {} was left out", at));
    }
    at += 8 + (std::size_t{size} + 3) / 4 * 4;
  }
  if (!has_json) return bad("no JSON chunk");
  while (!parts.json.empty() && (parts.json.back() == '\0' || parts.json.back() == ' ')) parts.json.remove_suffix(1);
  return parts;
}

}  // namespace lodestone::io
