#include "lodestone/io/gltf/meshopt_detail.h"

#include <fmt/format.h>

#ifdef LODESTONE_WITH_MESHOPT
#include <meshoptimizer.h>
#endif

namespace lodestone::io {

#ifdef LODESTONE_WITH_MESHOPT

namespace {

constexpr unsigned char kVersion1 = 0xa1;

}  // namespace

bool has_meshopt() { return true; }

Result<std::string> decode_meshopt(std::span<const std::byte> compressed, const MeshoptCoding& coding,
                                   const std::string& where) {
  const auto [mode, filter, count, stride] = coding;
  std::string out(count * stride, '\0');
  const auto* bytes = reinterpret_cast<const unsigned char*>(compressed.data());
  int problem = 0;
  switch (mode) {
    case MeshoptMode::attributes:
      if (!compressed.empty() && bytes[0] == kVersion1) {
        problem = decode_meshopt_version_1(compressed, count, stride, out.data()) ? 0 : -1;
      } else {
        problem = meshopt_decodeVertexBuffer(out.data(), count, stride, bytes, compressed.size());
      }
      break;
    case MeshoptMode::triangles:
      problem = meshopt_decodeIndexBuffer(out.data(), count, stride, bytes, compressed.size());
      break;
    case MeshoptMode::indices:
      problem = meshopt_decodeIndexSequence(out.data(), count, stride, bytes, compressed.size());
      break;
  }
  if (problem != 0) {
    return fail(ErrorCode::bad_format, fmt::format("the compressed data is broken (code {})", problem), where,
                "export the model again");
  }
  switch (filter) {
    case MeshoptFilter::none:
      break;
    case MeshoptFilter::octahedral:
      meshopt_decodeFilterOct(out.data(), count, stride);
      break;
    case MeshoptFilter::quaternion:
      meshopt_decodeFilterQuat(out.data(), count, stride);
      break;
    case MeshoptFilter::exponential:
      meshopt_decodeFilterExp(out.data(), count, stride);
      break;
    case MeshoptFilter::color:
      decode_meshopt_colors(out.data(), count, stride);
      break;
  }
  return out;
}

std::string encode_meshopt_vertices(std::span<const std::byte> vertices, std::size_t stride) {
  const std::size_t count = vertices.size() / stride;
  std::string out(meshopt_encodeVertexBufferBound(count, stride), '\0');
  out.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(out.data()), out.size(), vertices.data(),
                                        count, stride));
  return out;
}

std::string encode_meshopt_triangles(std::span<const std::uint32_t> indices, std::size_t vertex_count) {
  // glTF wants version 1 of the format; the library's default is not the same in all its versions.
  static const bool version_set = (meshopt_encodeIndexVersion(1), true);
  (void)version_set;
  std::string out(meshopt_encodeIndexBufferBound(indices.size(), vertex_count), '\0');
  out.resize(meshopt_encodeIndexBuffer(reinterpret_cast<unsigned char*>(out.data()), out.size(), indices.data(),
                                       indices.size()));
  return out;
}

#else

bool has_meshopt() { return false; }

Result<std::string> decode_meshopt(std::span<const std::byte>, const MeshoptCoding&, const std::string& where) {
  return fail(ErrorCode::unsupported, "meshopt compression is not in this build", where,
              "build with -DLODESTONE_WITH_MESHOPT=ON (Debian: libmeshoptimizer-dev)");
}

std::string encode_meshopt_vertices(std::span<const std::byte>, std::size_t) { return {}; }
std::string encode_meshopt_triangles(std::span<const std::uint32_t>, std::size_t) { return {}; }

#endif

}  // namespace lodestone::io
