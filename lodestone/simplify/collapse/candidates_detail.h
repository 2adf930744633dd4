// Edges that may collapse: where to, and at what cost.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "lodestone/simplify/collapse/state_detail.h"

namespace lodestone::simplify::detail {

/// An edge that may collapse, and how. 28 bytes.
struct Candidate {
  std::uint32_t kept, removed;
  Vec3f position;
  float cost;           ///< see Placement
  std::uint32_t stamp;  ///< collapses that the sweep had done when it was evaluated
};

/// Evaluates edges in groups of four; what comes out keeps the order of what went in.
class EdgeEvaluator {
 public:
  explicit EdgeEvaluator(const State& state) : state_(state) {}

  /// Edges from v to those neighbours u for which wanted(u). `corners` is v's star. Edges that can never collapse are
  /// left out. Quadrics of all ends must be up to date.
  template <class Wanted>
  void add_edges(std::uint32_t v, std::span<const Corner> corners, Wanted wanted) {
    if (state_.classes[v] == VertexClass::interior && add_spokes_of_fan(v, corners, wanted)) return;
    collect_spokes(corners);
    for (const Spoke& spoke : spokes_) {
      if (wanted(spoke.neighbour)) add(v, spoke);
    }
  }
  /// One edge with its triangles among the corners of `removed`.
  void add_edge(std::uint32_t kept, std::uint32_t removed, std::span<const Corner> corners_of_removed);

  /// What was evaluated since the last clear(), NaN and infinite costs included.
  std::vector<Candidate>& finish();
  void clear() { out_.clear(); }
  std::size_t size() const { return out_.size(); }

 private:
  // An edge from the vertex at hand with its triangles: the first two, and how many.
  struct Spoke {
    std::uint32_t neighbour;
    std::uint32_t triangles[2];
    std::uint32_t count;
  };
  // False = not one closed fan of few triangles; then nothing has been added.
  template <class Wanted>
  bool add_spokes_of_fan(std::uint32_t v, std::span<const Corner> corners, Wanted wanted) {
    if (!fan_.load(corners)) return false;
    std::array<std::uint32_t, 16> before;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      before[i] = fan_.before(corners[i].a);
      if (before[i] == kNone) return false;
    }
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const std::uint32_t u = corners[i].a;
      if (!wanted(u)) continue;
      const std::uint32_t first = corners[i].triangle, second = corners[before[i]].triangle;
      if (state_.classes[u] == VertexClass::interior && ((state_.zone[v] | state_.zone[u]) & kHeavy) == 0) {
        add_free(v, u, first, second);
      } else {
        add(v, {u, {first, second}, 2});
      }
    }
    return true;
  }
  void collect_spokes(std::span<const Corner> corners);
  void add(std::uint32_t v, const Spoke& spoke);
  void add_free(std::uint32_t v, std::uint32_t w, std::uint32_t first, std::uint32_t second);
  void flush();
  float attributes_of(const Candidate& candidate, bool moved, std::uint32_t first, std::uint32_t second) const;

  const State& state_;
  std::vector<Spoke> spokes_;
  Fan fan_;
  std::vector<Candidate> out_;
  std::size_t waiting_ = 0;
  std::array<std::uint32_t, 4> v_{}, w_{}, first_{}, second_{};
  std::array<std::size_t, 4> place_{};
};

/// Costs of NaN or infinity are none.
inline bool is_possible(float cost, float max_cost) { return cost <= max_cost && cost < 3e38F; }

/// Cost bin of a candidate: the exponent and three bits of the mantissa; bins rise with costs.
inline std::uint32_t bin_of(float cost) { return std::bit_cast<std::uint32_t>(cost) >> 20; }
inline constexpr std::size_t kBins = 2048;

}  // namespace lodestone::simplify::detail
