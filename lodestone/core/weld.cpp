// Exact welding: vertices at equal positions become one, equal wedges of a vertex become one.
//
// Method: items are parted by hash into buckets that fit the cache, with one small open-addressing table a bucket.
// 1. hash_position(), hash_wedge(), equal_wedges(): what counts as equal: positions as numbers (-0 is 0; what is no
//    number equals nothing), attributes bit for bit.
// 2. representatives(): hashes, a stable counting sort into buckets, and for each item the lowest one that equals it.
// 3. compact(): renumbers, and drops vertices and wedges that no triangle uses.
// 4. weld_exact(): vertices first, then wedges. wedge_classes(): representatives of wedges alone, by chosen streams.
// Invariants: the first of equals in index order stands for them, so neither hash nor threads show in the result. Order
// is kept; triangles and groups stay, though triangles may become degenerate. Cost: O(wedges), about 24 bytes a wedge.
#include "lodestone/core/weld.h"

#include <bit>
#include <cstring>
#include <utility>

#include "lodestone/base/index_table.h"
#include "lodestone/base/parallel.h"
#include "lodestone/base/random.h"
#include "lodestone/core/validate.h"

namespace lodestone {

namespace {

constexpr std::size_t kChunk = std::size_t{1} << 16;
constexpr unsigned kBucketBits = 8;
constexpr std::size_t kBuckets = std::size_t{1} << kBucketBits;

std::uint32_t bits_of(float value) { return std::bit_cast<std::uint32_t>(value + 0.0F); }  // -0 becomes 0

std::uint64_t hash_position(Vec3f p) {
  const std::uint64_t xy = std::uint64_t{bits_of(p.x)} << 32 | bits_of(p.y);
  return mix_bits(mix_bits(xy) ^ bits_of(p.z));
}

// The part of a stream's values that belongs to a wedge, as bytes.
struct TupleBytes {
  const char* data;
  std::size_t stride;
};

std::vector<TupleBytes> tuple_bytes(const Mesh& mesh, const std::vector<bool>& compared) {
  std::vector<TupleBytes> out;
  for (std::size_t i = 0; i < mesh.attributes.size(); ++i) {
    const AttributeStream& stream = mesh.attributes[i];
    if (!compared[i]) continue;
    std::visit(
        [&](const auto& values) {
          out.push_back({reinterpret_cast<const char*>(values.data()), stream.components * sizeof(values[0])});
        },
        stream.values);
  }
  return out;
}

std::uint64_t hash_wedge(const std::vector<TupleBytes>& tuples, std::uint32_t vertex, std::size_t wedge) {
  std::uint64_t h = mix_bits(vertex);
  for (const TupleBytes& t : tuples) {
    const char* p = t.data + wedge * t.stride;
    for (std::size_t i = 0; i < t.stride; i += 4) {
      std::uint32_t word = 0;
      std::memcpy(&word, p + i, 4);
      h = mix_bits(h ^ word);
    }
  }
  return h;
}

bool equal_wedges(const std::vector<TupleBytes>& tuples, std::size_t a, std::size_t b) {
  for (const TupleBytes& t : tuples) {
    if (std::memcmp(t.data + a * t.stride, t.data + b * t.stride, t.stride) != 0) return false;
  }
  return true;
}

// Equal to the bit counts as well: NaN is like no number, itself included, but many of them hash alike.
bool equal_positions(const Vec3f& a, const Vec3f& b) { return a == b || std::memcmp(&a, &b, sizeof a) == 0; }

// For each of n items the lowest equal item. hash(i) -> 64 bits, equal(i, j) -> bool.
template <class Hash, class Equal>
std::vector<std::uint32_t> representatives(std::size_t n, const Task& task, Hash hash, Equal equal) {
  std::vector<std::uint64_t> hashes(n);
  const std::size_t chunks = (n + kChunk - 1) / kChunk;
  std::vector<std::uint32_t> start(kBuckets * chunks, 0);  // bucket-major, so that a scan gives stable places
  parallel_for(n, kChunk, task, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
    for (std::size_t i = begin; i < end; ++i) {
      hashes[i] = hash(i);
      ++start[(hashes[i] >> (64 - kBucketBits)) * chunks + chunk];
    }
  });
  exclusive_scan(start, task);
  std::vector<std::uint32_t> bucket_first(kBuckets + 1, static_cast<std::uint32_t>(n));
  for (std::size_t b = 0; b < kBuckets && chunks > 0; ++b) bucket_first[b] = start[b * chunks];
  std::vector<std::uint32_t> order(n);
  parallel_for(n, kChunk, task, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
    for (std::size_t i = begin; i < end; ++i) {
      order[start[(hashes[i] >> (64 - kBucketBits)) * chunks + chunk]++] = static_cast<std::uint32_t>(i);
    }
  });
  std::vector<std::uint32_t> representative(n);
  parallel_for(kBuckets, 1, task, [&](std::size_t bucket, std::size_t, std::size_t) {
    const std::size_t first = bucket_first[bucket], count = bucket_first[bucket + 1] - first;
    IndexTable table(count);
    for (std::size_t k = 0; k < count; ++k) {
      const std::uint32_t item = order[first + k];
      representative[item] = table.find_or_add(hashes[item], item, [&](std::size_t other) {
        return hashes[other] == hashes[item] && equal(other, std::size_t{item});
      });
    }
  });
  return representative;
}

void compact_stream(AttributeStream& stream, const std::vector<std::uint32_t>& kept) {
  std::visit(
      [&](auto& values) {
        const std::size_t c = stream.components;
        std::remove_reference_t<decltype(values)> out(kept.size() * c);
        for (std::size_t i = 0; i < kept.size(); ++i) {
          for (std::size_t k = 0; k < c; ++k) out[i * c + k] = values[kept[i] * c + k];
        }
        values = std::move(out);
      },
      stream.values);
}

// Keeps only the wedges that stand for themselves and are used, and only the vertices that those use.
void compact(Mesh& mesh, const std::vector<std::uint32_t>& wedge_to, const std::vector<std::uint32_t>& vertex_to,
             const Task& task) {
  const std::size_t wedges = mesh.wedge_count();
  std::vector<std::uint32_t> wedge_new(wedges, 0), vertex_new(mesh.positions.size(), 0);
  for (Triangle& t : mesh.triangles) {
    for (std::uint32_t& w : t) {
      w = wedge_to[w];
      wedge_new[w] = 1;
      vertex_new[vertex_to[mesh.vertex_of(w)]] = 1;
    }
  }
  std::vector<std::uint32_t> kept_wedges, kept_vertices;
  for (std::uint32_t w = 0; w < wedges; ++w) {
    if (wedge_new[w] != 0) kept_wedges.push_back(w);
  }
  for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
    if (vertex_new[v] != 0) kept_vertices.push_back(v);
  }
  exclusive_scan(wedge_new, task);  // marks (1 = stays) become new numbers
  exclusive_scan(vertex_new, task);
  std::vector<std::uint32_t> wedge_vertex(kept_wedges.size());
  bool identity = kept_wedges.size() == kept_vertices.size();
  for (std::size_t i = 0; i < kept_wedges.size(); ++i) {
    wedge_vertex[i] = vertex_new[vertex_to[mesh.vertex_of(kept_wedges[i])]];
    identity = identity && wedge_vertex[i] == i;
  }
  for (Triangle& t : mesh.triangles) {
    for (std::uint32_t& w : t) w = wedge_new[w];
  }
  if (kept_vertices.size() != mesh.positions.size()) {
    for (std::size_t i = 0; i < kept_vertices.size(); ++i) mesh.positions[i] = mesh.positions[kept_vertices[i]];
    mesh.positions.resize(kept_vertices.size());
  }
  if (kept_wedges.size() != wedges) {
    for (AttributeStream& stream : mesh.attributes) compact_stream(stream, kept_wedges);
  }
  mesh.wedge_vertex = identity ? std::vector<std::uint32_t>{} : std::move(wedge_vertex);
}

bool all_used_and_distinct(const Mesh& mesh, const std::vector<std::uint32_t>& vertex_to) {
  if (!mesh.wedge_vertex.empty()) return false;
  for (std::uint32_t v = 0; v < vertex_to.size(); ++v) {
    if (vertex_to[v] != v) return false;
  }
  std::vector<std::uint8_t> used(mesh.positions.size(), 0);
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t w : t) used[w] = 1;
  }
  for (const std::uint8_t u : used) {
    if (u == 0) return false;
  }
  return true;
}

}  // namespace

Result<Mesh> weld_exact(Mesh mesh, Task task) {
  LODESTONE_TRY(validate_indices(mesh, task));
  const std::vector<std::uint32_t> vertex_to = representatives(
      mesh.positions.size(), task, [&](std::size_t v) { return hash_position(mesh.positions[v]); },
      [&](std::size_t a, std::size_t b) { return equal_positions(mesh.positions[a], mesh.positions[b]); });
  if (task.cancelled()) return cancelled_error("welding");
  if (all_used_and_distinct(mesh, vertex_to)) return mesh;
  const std::vector<TupleBytes> tuples = tuple_bytes(mesh, std::vector<bool>(mesh.attributes.size(), true));
  const auto vertex = [&](std::size_t w) { return vertex_to[mesh.vertex_of(static_cast<std::uint32_t>(w))]; };
  const std::vector<std::uint32_t> wedge_to = representatives(
      mesh.wedge_count(), task, [&](std::size_t w) { return hash_wedge(tuples, vertex(w), w); },
      [&](std::size_t a, std::size_t b) { return vertex(a) == vertex(b) && equal_wedges(tuples, a, b); });
  if (task.cancelled()) return cancelled_error("welding");
  compact(mesh, wedge_to, vertex_to, task);
  return mesh;
}

std::vector<std::uint32_t> wedge_classes(const Mesh& mesh, const std::vector<bool>& compared, Task task) {
  const std::vector<TupleBytes> tuples = tuple_bytes(mesh, compared);
  const auto vertex = [&](std::size_t w) { return mesh.vertex_of(static_cast<std::uint32_t>(w)); };
  return representatives(
      mesh.wedge_count(), task, [&](std::size_t w) { return hash_wedge(tuples, vertex(w), w); },
      [&](std::size_t a, std::size_t b) { return vertex(a) == vertex(b) && equal_wedges(tuples, a, b); });
}

}  // namespace lodestone
