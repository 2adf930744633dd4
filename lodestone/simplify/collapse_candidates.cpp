// Quadrics of all vertices and the cost of every edge.
#include <algorithm>
#include <bit>

#include "lodestone/simplify/collapse_solve_detail.h"
#include "lodestone/simplify/collapse_state_detail.h"

namespace lodestone::simplify::detail {

namespace {

// Weight of a feature edge's line against the planes (area against area): 1 to 20 make no difference, 0 lets borders
// shrink.
constexpr float kLineWeight = 4.5F;

// The edges around one vertex with their triangles (the first two, and how many).
struct Spoke {
  std::uint32_t neighbour;
  std::uint32_t triangles[2];
  std::uint32_t count;
};

void add_spoke(std::vector<Spoke>& spokes, std::uint32_t neighbour, std::uint32_t triangle) {
  for (Spoke& s : spokes) {
    if (s.neighbour != neighbour) continue;
    if (s.count < 2) s.triangles[s.count] = triangle;
    ++s.count;
    return;
  }
  spokes.push_back({neighbour, {triangle, 0}, 1});
}

void collect_spokes(const State& state, std::uint32_t v, std::vector<Spoke>& spokes) {
  spokes.clear();
  for (const std::uint32_t t : state.star_of(v)) {
    for (const std::uint32_t u : state.triangles[t]) {
      if (u != v) add_spoke(spokes, u, t);
    }
  }
}

bool is_feature(const State& state, std::uint32_t v, const Spoke& spoke) {
  return spoke.count != 2 || is_feature_edge(state, v, spoke.neighbour, spoke.triangles);
}

// Squared distance to the line of each feature edge, weighed by the edge's squared length.
void add_lines(const State& state, std::uint32_t v, Quadric& q) {
  std::vector<Spoke> spokes;
  collect_spokes(state, v, spokes);
  for (const Spoke& s : spokes) {
    if (!is_feature(state, v, s)) continue;
    const Vec3f d = state.positions[s.neighbour] - state.positions[v];
    const float l = length_sq(d);
    q.xx += kLineWeight * (l - d.x * d.x);
    q.yy += kLineWeight * (l - d.y * d.y);
    q.zz += kLineWeight * (l - d.z * d.z);
    q.xy -= kLineWeight * d.x * d.y;
    q.xz -= kLineWeight * d.x * d.z;
    q.yz -= kLineWeight * d.y * d.z;
  }
}

Shared shared_of(const State& state, std::uint32_t v, const Spoke& spoke) {
  Shared shared;
  const auto add = [&](std::uint32_t t) {
    const Triangle& c = state.triangles[t];
    shared.add(state.positions[c[0]], state.positions[c[1]], state.positions[c[2]]);
  };
  for (std::uint32_t i = 0; i < std::min(spoke.count, 2U); ++i) add(spoke.triangles[i]);
  if (spoke.count <= 2) return shared;
  std::uint32_t seen = 0;
  for (const std::uint32_t t : state.star_of(v)) {
    const Triangle& c = state.triangles[t];
    const bool both = c[0] == spoke.neighbour || c[1] == spoke.neighbour || c[2] == spoke.neighbour;
    if (both && ++seen > 2) add(t);
  }
  return shared;
}

void add_candidate(const State& state, std::uint32_t v, const Spoke& spoke, std::vector<Candidate>& out) {
  const std::uint32_t w = spoke.neighbour;
  const VertexClass cv = state.classes[v], cw = state.classes[w];
  const bool both_on_features = cv != VertexClass::interior && cw != VertexClass::interior;
  if (both_on_features) {
    if (cv == VertexClass::fixed && cw == VertexClass::fixed) return;
    if (!is_feature(state, v, spoke)) return;
  }
  if (state.star_of(w).size() > kMaxValence) return;
  Candidate candidate{v, w, {}, 0, 0};
  Placement placement;
  if (cv == cw) {
    placement = place_freely(state.quadrics[v], state.quadrics[w], shared_of(state, v, spoke));
  } else {
    if (cv < cw) std::swap(candidate.kept, candidate.removed);  // the higher class stays
    placement = place_at(state.quadrics[candidate.kept], state.quadrics[candidate.removed]);
  }
  if (!(placement.cost < 3e38F)) return;
  candidate.position = placement.position;
  candidate.cost = placement.cost;
  candidate.weight = placement.weight;
  out.push_back(candidate);
}

}  // namespace

Quadric quadric_of(const State& state, std::uint32_t v) {
  Quadric q;
  q.position = state.positions[v];
  for (const std::uint32_t t : state.star_of(v)) {
    const Triangle& c = state.triangles[t];
    const std::uint32_t i = state.remap[c[0]], j = state.remap[c[1]], k = state.remap[c[2]];
    if (i == j || j == k || k == i) continue;
    const Vec3f a = state.positions[i];
    const Vec3f n = cross(state.positions[j] - a, state.positions[k] - a);
    const float l = length(n);
    if (!(l > 0)) continue;
    const Vec3f u = n * (1 / l);
    q.xx += n.x * u.x;
    q.xy += n.x * u.y;
    q.xz += n.x * u.z;
    q.yy += n.y * u.y;
    q.yz += n.y * u.z;
    q.zz += n.z * u.z;
    q.volume += n;
  }
  if (state.classes[v] != VertexClass::interior) add_lines(state, v, q);
  return q;
}

void collect_candidates(const State& state, std::uint32_t begin, std::uint32_t end, std::vector<Candidate>& out) {
  out.clear();
  std::vector<Spoke> spokes;
  for (std::uint32_t v = begin; v < end; ++v) {
    if (state.star_of(v).size() > kMaxValence) continue;
    collect_spokes(state, v, spokes);
    for (const Spoke& spoke : spokes) {
      if (spoke.neighbour > v) add_candidate(state, v, spoke, out);
    }
  }
}

std::size_t bin_of(float cost) { return std::bit_cast<std::uint32_t>(cost) >> 20; }

}  // namespace lodestone::simplify::detail
