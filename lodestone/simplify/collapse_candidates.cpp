// Quadrics of all vertices and the cost of every edge.
#include <algorithm>
#include <array>
#include <bit>

#include "lodestone/base/parallel.h"
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

// The spokes to higher vertices of an interior vertex whose triangles all turn the same way: each edge leaves v in one
// triangle and comes back in another. False = not so here.
bool collect_higher_spokes(const State& state, std::uint32_t v, std::vector<Spoke>& spokes) {
  constexpr std::size_t kMost = 16;
  const auto star = state.star_of(v);
  if (star.size() > kMost) return false;
  std::array<std::uint32_t, kMost> next, last;
  for (std::size_t i = 0; i < star.size(); ++i) {
    const Triangle& c = state.triangles[star[i]];
    next[i] = c[0] == v ? c[1] : c[1] == v ? c[2] : c[0];
    last[i] = c[0] == v ? c[2] : c[1] == v ? c[0] : c[1];
  }
  spokes.clear();
  for (std::size_t i = 0; i < star.size(); ++i) {
    if (next[i] < v) continue;
    std::size_t j = 0;
    while (j < star.size() && last[j] != next[i]) ++j;
    if (j == star.size()) return false;
    spokes.push_back({next[i], {star[i], star[j]}, 2});
  }
  return true;
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

void add_plane(Quadric& q, const TriangleNormal& t) {
  const Vec3f n = t.n, u = n * t.inverse_length;
  q.xx += n.x * u.x;
  q.xy += n.x * u.y;
  q.xz += n.x * u.z;
  q.yy += n.y * u.y;
  q.yz += n.y * u.z;
  q.zz += n.z * u.z;
  q.volume += n;
}

// Rows a, b, c, d become columns.
void transpose(Float4& a, Float4& b, Float4& c, Float4& d) {
  const Float4 ab_low = __builtin_shufflevector(a, b, 0, 4, 1, 5), ab_high = __builtin_shufflevector(a, b, 2, 6, 3, 7);
  const Float4 cd_low = __builtin_shufflevector(c, d, 0, 4, 1, 5), cd_high = __builtin_shufflevector(c, d, 2, 6, 3, 7);
  a = __builtin_shufflevector(ab_low, cd_low, 0, 1, 4, 5);
  b = __builtin_shufflevector(ab_low, cd_low, 2, 3, 6, 7);
  c = __builtin_shufflevector(ab_high, cd_high, 0, 1, 4, 5);
  d = __builtin_shufflevector(ab_high, cd_high, 2, 3, 6, 7);
}

struct QuadricLanes {
  Float4 f[12];  // the members of Quadric in order, four quadrics side by side
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

// Edges between free ends, placed four at a time; the results go to places kept for them, so the order of candidates
// stays.
class Batch {
 public:
  Batch(const State& state, std::vector<Candidate>& out) : state_(state), out_(out) {}

  void add(std::uint32_t v, std::uint32_t w, std::uint32_t first, std::uint32_t second) {
    v_[size_] = v;
    w_[size_] = w;
    first_[size_] = first;
    second_[size_] = second;
    place_[size_] = out_.size();
    out_.push_back({v, w, {}, 0});
    if (++size_ == 4) flush();
  }

  void flush() {
    if (size_ == 0) return;
    for (std::size_t i = size_; i < 4; ++i) {  // spare lanes repeat the first edge
      v_[i] = v_[0];
      w_[i] = w_[0];
      first_[i] = first_[0];
      second_[i] = second_[0];
    }
    const QuadricLanes v = load_four(state_, v_), w = load_four(state_, w_);
    EdgeTerms<Float4> terms;
    terms.a0 = {v.f[0], v.f[1], v.f[2], v.f[3], v.f[4], v.f[5]};
    terms.a1 = {w.f[0], w.f[1], w.f[2], w.f[3], w.f[4], w.f[5]};
    terms.g0 = {v.f[6], v.f[7], v.f[8]};
    terms.g1 = {w.f[6], w.f[7], w.f[8]};
    terms.edge = {w.f[9] - v.f[9], w.f[10] - v.f[10], w.f[11] - v.f[11]};
    for (std::size_t t = 0; t < 2; ++t) {
      const std::array<std::uint32_t, 4>& triangles = t == 0 ? first_ : second_;
      Float4 rows[4];
      for (std::size_t i = 0; i < 4; ++i) rows[i] = *reinterpret_cast<const Float4*>(&state_.normals[triangles[i]]);
      transpose(rows[0], rows[1], rows[2], rows[3]);
      terms.n[t] = {rows[0], rows[1], rows[2]};
      terms.inverse_length[t] = rows[3];
    }
    const EdgePlacement<Float4> p = place_freely(terms);
    const Float4 x = v.f[9] + p.position.x, y = v.f[10] + p.position.y, z = v.f[11] + p.position.z;
    for (std::size_t i = 0; i < size_; ++i) {
      Candidate& candidate = out_[place_[i]];
      candidate.position = {x[i], y[i], z[i]};
      candidate.cost = p.cost[i];
    }
    size_ = 0;
  }

 private:
  const State& state_;
  std::vector<Candidate>& out_;
  std::size_t size_ = 0;
  std::array<std::uint32_t, 4> v_{}, w_{}, first_{}, second_{};
  std::array<std::size_t, 4> place_{};
};

// Decides which end stays and asks for the placement that this leaves.
void add_candidate(const State& state, std::uint32_t v, const Spoke& spoke, Batch& batch, std::vector<Candidate>& out) {
  const std::uint32_t w = spoke.neighbour;
  const VertexClass cv = state.classes[v], cw = state.classes[w];
  if (cv != VertexClass::interior && cw != VertexClass::interior) {
    if (cv == VertexClass::fixed && cw == VertexClass::fixed) return;
    if (!is_feature(state, v, spoke)) return;
  }
  if (state.star_of(w).size() > kMaxValence) return;
  if (cv == cw) {
    const auto none = static_cast<std::uint32_t>(state.triangles.size());
    // Of the pages of a non-manifold edge two are taken out and the others count twice, which only makes it dearer.
    batch.add(v, w, spoke.triangles[0], spoke.count > 1 ? spoke.triangles[1] : none);
    return;
  }
  const std::uint32_t kept = cv < cw ? w : v, removed = cv < cw ? v : w;  // the higher class stays
  const Placement p = place_at(state.quadrics[kept], state.quadrics[removed]);
  out.push_back({kept, removed, p.position, p.cost});
}

}  // namespace

TriangleNormal triangle_normal(Vec3f a, Vec3f b, Vec3f c) {
  const Vec3f n = cross(b - a, c - a);
  const float l = length(n);
  return {n, l > 0 ? 1 / l : 0};
}

void compute_quadrics(State& state, const Task& task) {
  const std::size_t n = state.positions.size(), range = vertices_per_range(n);
  state.normals.resize(state.triangles.size() + 1);
  state.normals.back() = {};
  parallel_for(state.triangles.size(), 8192, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t t = begin; t < end; ++t) {
      const Triangle& c = state.triangles[t];
      state.normals[t] = triangle_normal(state.positions[c[0]], state.positions[c[1]], state.positions[c[2]]);
    }
  });
  state.quadrics.resize(n);
  state.inner.resize(n);
  parallel_for(n, 4096, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (auto v = static_cast<std::uint32_t>(begin); v < end; ++v) {
      Quadric q;
      q.position = state.positions[v];
      std::uint32_t lowest = v, highest = v;
      for (const std::uint32_t t : state.star_of(v)) {
        add_plane(q, state.normals[t]);
        const Triangle& c = state.triangles[t];
        lowest = std::min({lowest, c[0], c[1], c[2]});
        highest = std::max({highest, c[0], c[1], c[2]});
      }
      if (state.classes[v] != VertexClass::interior) add_lines(state, v, q);
      state.quadrics[v] = q;
      state.inner[v] = lowest / range == highest / range ? 1 : 0;
    }
  });
}

Quadric current_quadric(const State& state, std::uint32_t v) {
  Quadric q;
  q.position = state.positions[v];
  for (const std::uint32_t t : state.star_of(v)) {
    const Triangle& c = state.triangles[t];
    const std::uint32_t i = state.remap[c[0]], j = state.remap[c[1]], k = state.remap[c[2]];
    if (i == j || j == k || k == i) continue;
    add_plane(q, triangle_normal(state.positions[i], state.positions[j], state.positions[k]));
  }
  return q;
}

void collect_candidates(const State& state, std::uint32_t begin, std::uint32_t end, std::vector<Candidate>& out) {
  out.clear();
  out.reserve((end - begin) * std::size_t{3} + 16);
  std::vector<Spoke> spokes;
  Batch batch(state, out);
  for (std::uint32_t v = begin; v < end; ++v) {
    if (state.star_of(v).size() > kMaxValence) continue;
    if (state.classes[v] != VertexClass::interior || !collect_higher_spokes(state, v, spokes)) {
      collect_spokes(state, v, spokes);
    }
    for (const Spoke& spoke : spokes) {
      if (spoke.neighbour > v) add_candidate(state, v, spoke, batch, out);
    }
  }
  batch.flush();
  std::erase_if(out, [](const Candidate& c) { return !(c.cost < 3e38F); });
}

std::size_t bin_of(float cost) { return std::bit_cast<std::uint32_t>(cost) >> 20; }

}  // namespace lodestone::simplify::detail
