#include "lodestone/io/meshopt_detail.h"

#include <fmt/format.h>

#ifdef LODESTONE_WITH_MESHOPT
#include <meshoptimizer.h>
#endif

namespace lodestone::io {

#ifdef LODESTONE_WITH_MESHOPT

namespace {

// A block of 256 elements takes at least 4 bytes for each of its byte columns, a triangle at least one byte for its 12:
// nothing unfolds to more than this many times its size.
constexpr std::size_t kMaxRatio = 64;

}  // namespace

bool has_meshopt() { return true; }

Result<std::string> decode_meshopt(std::span<const std::byte> compressed, std::size_t count, std::size_t stride,
                                   MeshoptMode mode, MeshoptFilter filter, const std::string& where) {
  const auto bad = [&](std::string what) { return fail(ErrorCode::bad_format, std::move(what), where); };
  const bool attributes = mode == MeshoptMode::attributes;
  if (attributes ? stride == 0 || stride % 4 != 0 || stride > 256 : stride != 2 && stride != 4) {
    return bad(fmt::format("byteStride {} is not possible for {}", stride, attributes ? "ATTRIBUTES" : "indices"));
  }
  if (mode == MeshoptMode::triangles && count % 3 != 0) {
    return bad(fmt::format("count {} is no multiple of 3", count));
  }
  if (count > compressed.size() * kMaxRatio || count * stride > compressed.size() * kMaxRatio) {
    return bad(
        fmt::format("{} elements of {} bytes cannot be in {} compressed bytes", count, stride, compressed.size()));
  }
  const bool oct = filter == MeshoptFilter::octahedral, quat = filter == MeshoptFilter::quaternion;
  if (filter != MeshoptFilter::none && (!attributes || (oct && stride != 4 && stride != 8) || (quat && stride != 8))) {
    return bad(fmt::format("the filter is not possible for byteStride {}", stride));
  }
  std::string out(count * stride, '\0');
  const auto* bytes = reinterpret_cast<const unsigned char*>(compressed.data());
  int problem = 0;
  switch (mode) {
    case MeshoptMode::attributes:
      problem = meshopt_decodeVertexBuffer(out.data(), count, stride, bytes, compressed.size());
      break;
    case MeshoptMode::triangles:
      problem = meshopt_decodeIndexBuffer(out.data(), count, stride, bytes, compressed.size());
      break;
    case MeshoptMode::indices:
      problem = meshopt_decodeIndexSequence(out.data(), count, stride, bytes, compressed.size());
      break;
  }
  if (problem != 0) return bad(fmt::format("the compressed data is broken (code {})", problem));
  if (oct) meshopt_decodeFilterOct(out.data(), count, stride);
  if (quat) meshopt_decodeFilterQuat(out.data(), count, stride);
  if (filter == MeshoptFilter::exponential) meshopt_decodeFilterExp(out.data(), count, stride);
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

Result<std::string> decode_meshopt(std::span<const std::byte>, std::size_t, std::size_t, MeshoptMode, MeshoptFilter,
                                   const std::string& where) {
  return fail(ErrorCode::unsupported, "EXT_meshopt_compression is not in this build", where,
              "build with -DLODESTONE_WITH_MESHOPT=ON (Debian: libmeshoptimizer-dev)");
}

std::string encode_meshopt_vertices(std::span<const std::byte>, std::size_t) { return {}; }
std::string encode_meshopt_triangles(std::span<const std::uint32_t>, std::size_t) { return {}; }

#endif

}  // namespace lodestone::io
