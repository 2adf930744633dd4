// WedgeTable: a wedge for each vertex with a pair of keys (indices of UV and normal, or the bits of a UV).
#pragma once

#include <cstdint>
#include <vector>

#include "lodestone/core/mesh.h"

namespace lodestone::io {

class WedgeTable {
 public:
  /// The wedge of this vertex with these keys: the one handed out before, or a new one. Equal wedges may come twice at
  /// vertices with very many (weld_exact joins them); so each call takes a bounded time.
  std::uint32_t wedge(std::uint32_t vertex, std::uint32_t a, std::uint32_t b) {
    if (vertex >= last_of_.size()) last_of_.resize(std::size_t{vertex} + 1, kNone);
    constexpr int kLongestSearch = 24;
    int steps = 0;
    for (std::uint32_t w = last_of_[vertex]; w != kNone && steps < kLongestSearch; w = previous_[w], ++steps) {
      if (key_a[w] == a && key_b[w] == b) return w;
    }
    const auto w = static_cast<std::uint32_t>(wedge_vertex.size());
    wedge_vertex.push_back(vertex);
    key_a.push_back(a);
    key_b.push_back(b);
    previous_.push_back(last_of_[vertex]);
    last_of_[vertex] = w;
    return w;
  }

  /// Wedge i is vertex i for all vertices so far, with keys kNone.
  void start_with_vertices(std::size_t vertices) {
    for (std::uint32_t v = 0; v < vertices; ++v) wedge(v, kNone, kNone);
  }

  std::vector<std::uint32_t> wedge_vertex, key_a, key_b;  // by wedge

 private:
  std::vector<std::uint32_t> last_of_;   // by vertex
  std::vector<std::uint32_t> previous_;  // by wedge: an older wedge of the same vertex
};

}  // namespace lodestone::io
