// Quadrics of vertices, and for each edge where its two vertices merge best and what that costs.
//
// Quadrics are those of [garland-heckbert-1997], made memoryless and volume-preserving as in [lindstrom-turk-1998].
// Weights, and what differs from the papers: docs/papers/edge-collapse.md, "Cost and placement".
//
// 1. renew_quadric(): the quadric of a vertex about itself, from its star as it is (renew_position_quadric()). Vertices
//    on feature edges also get the squared distances to the lines of these edges (add_lines()), which hold borders and
//    seams in place. Wedges get theirs in attributes.cpp.
// 2. EdgeEvaluator::add_edges() (candidates_detail.h) finds a vertex's edges and the triangles at each, through
//    collect_spokes() where the star is not one closed fan.
// 3. add() leaves out edges that can never collapse and decides which end stays: of two classes the higher, with the
//    position that it has (place_at()). Ends of one class are both free: add_free() puts them into groups of four.
// 4. flush() places a group at once (place_freely(), solve_detail.h). The cost is that of positions and attributes, at
//    least that of the accumulated error, times the importance of the ends.
//
// Four edges at once give the same bits as one, and the output keeps the order of the input: the result depends on the
// mesh alone. O(valence) for a vertex, O(1) for an edge.
#include <algorithm>
#include <array>

#include "lodestone/simplify/collapse/attributes_detail.h"
#include "lodestone/simplify/collapse/candidates_detail.h"
#include "lodestone/simplify/collapse/solve_detail.h"

namespace lodestone::simplify::detail {

namespace {

// Weight of a feature edge's line against the planes (area against area). 1 to 20 make no difference; without it
// borders shrink.
constexpr float kLineWeight = 4.5F;

Float4 load(const TriangleNormal& t) { return *reinterpret_cast<const Float4*>(&t); }

// Squared distance to the line of a feature edge, weighed by the edge's length cubed.
void add_line(Quadric& q, Vec3f d) {
  const float l = length_sq(d), weight = kLineWeight * std::sqrt(l);
  q.xx += weight * (l - d.x * d.x);
  q.yy += weight * (l - d.y * d.y);
  q.zz += weight * (l - d.z * d.z);
  q.xy -= weight * d.x * d.y;
  q.zx -= weight * d.x * d.z;
  q.yz -= weight * d.y * d.z;
}

void add_lines(const State& state, std::uint32_t v, Quadric& q) {
  std::vector<Corner> memory;
  const std::span<const Corner> corners = gather(state, v, memory);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    for (const std::uint32_t u : {corners[i].a, corners[i].b}) {
      std::uint32_t both[2] = {corners[i].triangle, 0};
      std::size_t count = 1;
      bool first = true;
      for (std::size_t j = 0; j < corners.size(); ++j) {
        if (j == i || (corners[j].a != u && corners[j].b != u)) continue;
        first = first && j > i;
        if (count < 2) both[count] = corners[j].triangle;
        ++count;
      }
      if (first && (count != 2 || is_feature_edge(state, v, u, both))) {
        add_line(q, state.positions[u] - state.positions[v]);
      }
    }
  }
}

void renew_position_quadric(State& state, std::uint32_t v) {
  // Diagonal (xx, yy, zz) and the rest (xy, yz, zx) of the sum of n n^T / sqrt(|n|), and the sum of n.
  Float4 diagonal{}, rest{}, sum{};
  for (const std::uint32_t entry : state.star_of(v)) {
    const Float4 n = load(state.normals[entry >> 2]), scaled = n * __builtin_shufflevector(n, n, 3, 3, 3, 3);
    diagonal += scaled * n;
    rest += scaled * __builtin_shufflevector(n, n, 1, 2, 0, 3);
    sum += n;
  }
  const Vec3f p = state.positions[v];
  diagonal[3] = p.x;
  rest[3] = p.y;
  sum[3] = p.z;
  auto* rows = reinterpret_cast<Float4*>(&state.quadrics[v]);
  rows[0] = diagonal;
  rows[1] = rest;
  rows[2] = sum;
}

struct QuadricLanes {
  Float4 f[12];  // the members of Quadric in order, four quadrics side by side

  Sym3<Float4> matrix() const { return {f[0], f[4], f[6], f[1], f[5], f[2]}; }
};

QuadricLanes load_four(const State& state, const std::array<std::uint32_t, 4>& vertices) {
  static_assert(sizeof(Quadric) == 48);
  QuadricLanes lanes;
  for (std::size_t block = 0; block < 3; ++block) {
    Float4 rows[4];
    for (std::size_t i = 0; i < 4; ++i) {
      rows[i] = reinterpret_cast<const Float4*>(&state.quadrics[vertices[i]])[block];
    }
    transpose(rows[0], rows[1], rows[2], rows[3]);
    for (std::size_t i = 0; i < 4; ++i) lanes.f[4 * block + i] = rows[i];
  }
  return lanes;
}

}  // namespace

void renew_quadric(State& state, std::uint32_t v) {
  renew_position_quadric(state, v);
  if (state.classes[v] == VertexClass::feature) add_lines(state, v, state.quadrics[v]);
  if (state.attributes.blocks > 0) renew_attribute_quadrics(state, v);
}

void EdgeEvaluator::collect_spokes(std::span<const Corner> corners) {
  spokes_.clear();
  for (const Corner& c : corners) {
    for (const std::uint32_t u : {c.a, c.b}) {
      const auto known = std::find_if(spokes_.begin(), spokes_.end(), [&](const Spoke& s) { return s.neighbour == u; });
      if (known == spokes_.end()) {
        spokes_.push_back({u, {c.triangle, 0}, 1});
        continue;
      }
      if (known->count < 2) known->triangles[known->count] = c.triangle;
      ++known->count;
    }
  }
}

// Decides which end stays and asks for the placement that this leaves.
void EdgeEvaluator::add(std::uint32_t v, const Spoke& spoke) {
  const std::uint32_t w = spoke.neighbour;
  const VertexClass cv = state_.classes[v], cw = state_.classes[w];
  if (cv != VertexClass::interior && cw != VertexClass::interior) {
    if (cv == VertexClass::no_move && cw == VertexClass::no_move) return;
    if (spoke.count == 2 && !is_feature_edge(state_, v, w, spoke.triangles)) return;
  }
  if (((state_.zone[v] | state_.zone[w]) & kHeavy) != 0) return;
  if (cv == cw) {
    // Of the pages of a non-manifold edge two are taken out and the others count twice, which only makes it dearer.
    const auto none = static_cast<std::uint32_t>(state_.triangles.size());
    add_free(v, w, spoke.triangles[0], spoke.count > 1 ? spoke.triangles[1] : none);
    return;
  }
  const std::uint32_t kept = cv < cw ? w : v, removed = cv < cw ? v : w;  // the higher class stays
  const Placement p = place_at(state_.quadrics[kept], state_.quadrics[removed]);
  Candidate candidate{kept, removed, p.position, p.cost, 0};
  if (state_.attributes.blocks > 0) {
    const std::uint32_t second = spoke.count > 1 ? spoke.triangles[1] : kNone;
    candidate.cost += attributes_of(candidate, false, spoke.triangles[0], second);
  }
  candidate.cost = std::max(candidate.cost, state_.cost_of_error(kept, removed, 0)) * state_.weight_of(kept, removed);
  out_.push_back(candidate);
}

void EdgeEvaluator::add_edge(std::uint32_t kept, std::uint32_t removed, std::span<const Corner> corners_of_removed) {
  Spoke spoke{kept, {0, 0}, 0};
  for (const Corner& c : corners_of_removed) {
    if (c.a != kept && c.b != kept) continue;
    if (spoke.count < 2) spoke.triangles[spoke.count] = c.triangle;
    ++spoke.count;
  }
  if (spoke.count > 0) add(removed, spoke);
}

void EdgeEvaluator::add_free(std::uint32_t v, std::uint32_t w, std::uint32_t first, std::uint32_t second) {
  v_[waiting_] = v;
  w_[waiting_] = w;
  first_[waiting_] = first;
  second_[waiting_] = second;
  place_[waiting_] = out_.size();
  out_.push_back({v, w, {}, 0, 0});
  if (++waiting_ == 4) flush();
}

float EdgeEvaluator::attributes_of(const Candidate& candidate, bool moved, std::uint32_t first,
                                   std::uint32_t second) const {
  const std::uint32_t both[2] = {first, second};
  const std::size_t count = second < state_.triangles.size() ? 2 : 1;
  return edge_attribute_cost(state_, candidate.kept, candidate.removed, moved, candidate.position,
                             std::span(both).first(count));
}

void EdgeEvaluator::flush() {
  if (waiting_ == 0) return;
  for (std::size_t i = waiting_; i < 4; ++i) {  // spare lanes repeat the first edge
    v_[i] = v_[0];
    w_[i] = w_[0];
    first_[i] = first_[0];
    second_[i] = second_[0];
  }
  const QuadricLanes v = load_four(state_, v_), w = load_four(state_, w_);
  EdgeTerms<Float4> terms;
  terms.a0 = v.matrix();
  terms.a1 = w.matrix();
  terms.g0 = {v.f[8], v.f[9], v.f[10]};
  terms.g1 = {w.f[8], w.f[9], w.f[10]};
  terms.edge = {w.f[3] - v.f[3], w.f[7] - v.f[7], w.f[11] - v.f[11]};
  for (std::size_t t = 0; t < 2; ++t) {
    const std::array<std::uint32_t, 4>& triangles = t == 0 ? first_ : second_;
    Float4 rows[4];
    for (std::size_t i = 0; i < 4; ++i) rows[i] = load(state_.normals[triangles[i]]);
    transpose(rows[0], rows[1], rows[2], rows[3]);
    terms.n[t] = {rows[0], rows[1], rows[2]};
    terms.inverse_root[t] = rows[3];
  }
  const EdgePlacement<Float4> p = place_freely(terms);
  const Float4 cost = p.cost, mean_square = p.mean_square;
  const Float4 x = v.f[3] + p.position.x, y = v.f[7] + p.position.y, z = v.f[11] + p.position.z;
  for (std::size_t i = 0; i < waiting_; ++i) {
    Candidate& candidate = out_[place_[i]];
    candidate.position = {x[i], y[i], z[i]};
    candidate.cost = cost[i];
    if (state_.attributes.blocks > 0) candidate.cost += attributes_of(candidate, true, first_[i], second_[i]);
    candidate.cost = std::max(candidate.cost, state_.cost_of_error(candidate.kept, candidate.removed, mean_square[i])) *
                     state_.weight_of(candidate.kept, candidate.removed);
  }
  waiting_ = 0;
}

std::vector<Candidate>& EdgeEvaluator::finish() {
  flush();
  return out_;
}

}  // namespace lodestone::simplify::detail
