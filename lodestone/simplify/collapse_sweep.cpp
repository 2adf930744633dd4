// The sweep: one collapse after the other, each checked against the mesh as it is at that moment.
#include <algorithm>
#include <cmath>

#include "lodestone/simplify/collapse_solve_detail.h"
#include "lodestone/simplify/collapse_state_detail.h"

namespace lodestone::simplify::detail {

namespace {

// A surviving triangle may turn by at most about 78 degrees.
constexpr float kMinTurnCosineSq = 0.2F * 0.2F;

}  // namespace

void Sweeper::gather(std::uint32_t v, std::vector<Corner>& corners) const {
  corners.clear();
  for (const std::uint32_t t : state_.star_of(v)) {
    const Triangle& c = state_.triangles[t];
    const std::size_t k = c[0] == v ? 0 : c[1] == v ? 1 : 2;
    const std::uint32_t a = state_.remap[c[(k + 1) % 3]], b = state_.remap[c[(k + 2) % 3]];
    if (a != b) corners.push_back({a, b, t});
  }
}

// Brings a candidate up to date when a star around it has changed. False = leave it for the next pass.
bool Sweeper::refresh(Candidate& candidate) const {
  const std::uint32_t k = candidate.kept, r = candidate.removed;
  if (state_.touched[k] == 0 && state_.touched[r] == 0) return true;
  if (state_.classes[r] != VertexClass::interior) return false;  // lines of features are only known at the pass's start
  const Quadric removed = state_.touched[r] != 0 ? current_quadric(state_, r) : state_.quadrics[r];
  Placement placement;
  if (state_.classes[k] == VertexClass::interior) {
    const Quadric kept = state_.touched[k] != 0 ? current_quadric(state_, k) : state_.quadrics[k];
    TriangleNormal shared[2];
    std::size_t count = 0;
    for (const Corner& c : removed_corners_) {
      if ((c.a != k && c.b != k) || count == 2) continue;
      shared[count++] = triangle_normal(state_.positions[r], state_.positions[c.a], state_.positions[c.b]);
    }
    placement = place_freely(kept, removed, shared, count);
  } else {
    placement = place_at(state_.quadrics[k], removed);
  }
  candidate.position = placement.position;
  candidate.cost = placement.cost;
  return true;
}

// Link condition (Dey et al. 1999): the vertices adjacent to both ends are just the third corners of the edge's
// triangles, and no two triangles fall together; something must be left, so that no closed piece falls below four
// vertices, no open one below three.
bool Sweeper::link_allows(const Candidate& candidate) {
  const std::uint32_t stamp = stamp_;
  stamp_ += 3;
  for (const Corner& c : kept_corners_) state_.mark[c.a] = state_.mark[c.b] = stamp;
  shared_ = 0;
  std::size_t common = 0, thirds = 0;
  for (const Corner& c : removed_corners_) {
    for (const std::uint32_t u : {c.a, c.b}) {
      if (u == candidate.kept || state_.mark[u] != stamp) continue;
      state_.mark[u] = stamp + 1;
      ++common;
    }
  }
  for (const Corner& c : removed_corners_) {
    if (c.a != candidate.kept && c.b != candidate.kept) continue;
    ++shared_;
    const std::uint32_t third = c.a == candidate.kept ? c.b : c.a;
    if (state_.mark[third] != stamp + 1) continue;
    state_.mark[third] = stamp + 2;
    ++thirds;
  }
  if (shared_ == 0 || common != thirds) return false;
  if (removed_corners_.size() + kept_corners_.size() == 2 * shared_) return false;
  const auto between_thirds = [&](const Corner& c) {
    return state_.mark[c.a] == stamp + 2 && state_.mark[c.b] == stamp + 2;
  };
  for (const Corner& r : removed_corners_) {
    if (!between_thirds(r)) continue;
    for (const Corner& k : kept_corners_) {
      if (between_thirds(k) && ((k.a == r.a && k.b == r.b) || (k.a == r.b && k.b == r.a))) return false;
    }
  }
  return true;
}

bool Sweeper::flips(const std::vector<Corner>& corners, std::uint32_t self, std::uint32_t other, Vec3f to) const {
  const Vec3f from = state_.positions[self];
  for (const Corner& c : corners) {
    if (c.a == other || c.b == other) continue;
    const Vec3f a = state_.positions[c.a], b = state_.positions[c.b];
    const Vec3f before = cross(a - from, b - from), after = cross(a - to, b - to);
    const float before_sq = length_sq(before);
    if (before_sq == 0) continue;
    const float d = dot(before, after);
    if (!(d > 0 && d * d > kMinTurnCosineSq * before_sq * length_sq(after))) return true;
  }
  return false;
}

std::uint32_t Sweeper::nearest_normal(std::uint32_t wedge, std::uint32_t chart) const {
  std::uint32_t best = kNone;
  float best_cosine = -2;
  for (const std::uint32_t k : kept_wedges_) {
    if (state_.chart[k] != chart) continue;
    const float cosine = state_.wedge_normals.empty() ? 0 : dot(state_.wedge_normals[k], state_.wedge_normals[wedge]);
    if (cosine > best_cosine) {
      best = k;
      best_cosine = cosine;
    }
  }
  return best;
}

// Finds for each wedge of the removed vertex the wedge of the kept one that takes over: across the edge's triangles
// where they say it, else (normals split at the vertex, textures not) the one in the same chart whose normal is
// nearest. False = no match.
bool Sweeper::pair_wedges(const Candidate& candidate, bool moved) {
  const auto wedge_of = [&](std::uint32_t triangle, std::uint32_t vertex) {
    const Triangle& c = state_.triangles[triangle];
    const Triangle& w = state_.wedges[triangle];
    return c[0] == vertex ? w[0] : c[1] == vertex ? w[1] : w[2];
  };
  const auto find = [&](std::uint32_t wedge) {
    return std::find_if(pairs_.begin(), pairs_.end(), [&](const auto& p) { return p.first == wedge; });
  };
  pairs_.clear();
  kept_wedges_.clear();
  for (const Corner& c : kept_corners_) {
    const std::uint32_t w = wedge_of(c.triangle, candidate.kept);
    if (std::find(kept_wedges_.begin(), kept_wedges_.end(), w) == kept_wedges_.end()) kept_wedges_.push_back(w);
    if (c.a != candidate.removed && c.b != candidate.removed) continue;
    const std::uint32_t from = wedge_of(c.triangle, candidate.removed);
    const auto known = find(from);
    if (known == pairs_.end()) {
      pairs_.emplace_back(from, w);
    } else if (state_.chart[known->second] != state_.chart[w]) {
      return false;  // one wedge would have to become two
    }
  }
  const std::size_t across = pairs_.size();
  for (const Corner& c : removed_corners_) {
    const std::uint32_t from = wedge_of(c.triangle, candidate.removed);
    if (find(from) != pairs_.end()) continue;
    const auto kin = std::find_if(pairs_.begin(), pairs_.begin() + static_cast<std::ptrdiff_t>(across),
                                  [&](const auto& p) { return state_.chart[p.first] == state_.chart[from]; });
    if (kin == pairs_.begin() + static_cast<std::ptrdiff_t>(across)) return false;
    pairs_.emplace_back(from, nearest_normal(from, state_.chart[kin->second]));
  }
  if (!moved) return true;
  // A vertex that moves takes all its wedges along, so each needs a partner to blend with.
  return std::all_of(kept_wedges_.begin(), kept_wedges_.end(), [&](std::uint32_t k) {
    return std::any_of(pairs_.begin(), pairs_.end(),
                       [&](const auto& p) { return state_.chart[p.second] == state_.chart[k]; });
  });
}

// How far the new position is from the planes of the triangles around, at most: a mean over areas would hide that a
// thin tip is cut.
float Sweeper::plane_distance(const Candidate& candidate) const {
  float most = 0;
  const auto look = [&](const std::vector<Corner>& corners, std::uint32_t self) {
    const Vec3f p = state_.positions[self];
    for (const Corner& c : corners) {
      const TriangleNormal t = triangle_normal(p, state_.positions[c.a], state_.positions[c.b]);
      most = std::max(most, std::abs(dot(t.n, candidate.position - p)) * t.inverse_length);
    }
  };
  look(kept_corners_, candidate.kept);
  look(removed_corners_, candidate.removed);
  return most;
}

void Sweeper::commit(const Candidate& candidate, bool moved, std::size_t first_merge) {
  const std::uint32_t k = candidate.kept, r = candidate.removed;
  const Vec3f from = state_.positions[k], edge = state_.positions[r] - from;
  const float l = length_sq(edge);
  const float t = moved && l > 0 ? std::clamp(dot(candidate.position - from, edge) / l, 0.0F, 1.0F) : 0.0F;
  for (const auto& [removed, kept] : pairs_) merges_.push_back({kept, removed, 0, true});
  if (t > 0) {
    for (const std::uint32_t wedge : kept_wedges_) {
      const auto same = std::find_if(pairs_.begin(), pairs_.end(), [&](const auto& p) { return p.second == wedge; });
      if (same != pairs_.end()) {
        merges_[first_merge + static_cast<std::size_t>(same - pairs_.begin())].blend = t;
        continue;
      }
      const auto kin = std::find_if(pairs_.begin(), pairs_.end(),
                                    [&](const auto& p) { return state_.chart[p.second] == state_.chart[wedge]; });
      merges_.push_back({wedge, kin->first, t, false});
    }
  }
  state_.remap[r] = k;
  if (moved) state_.positions[k] = candidate.position;
  state_.done[k] = state_.done[r] = 1;
  for (const auto* corners : {&kept_corners_, &removed_corners_}) {
    for (const Corner& c : *corners) state_.touched[c.a] = state_.touched[c.b] = 1;
  }
}

bool Sweeper::try_collapse(Candidate candidate, float max_cost) {
  const std::uint32_t k = candidate.kept, r = candidate.removed;
  if ((state_.done[k] | state_.done[r]) != 0) return false;
  gather(k, kept_corners_);
  gather(r, removed_corners_);
  if (!refresh(candidate) || !(candidate.cost <= max_cost)) return false;
  if (!link_allows(candidate)) return false;
  const bool moved = state_.classes[k] == state_.classes[r];
  if (flips(removed_corners_, r, k, candidate.position)) return false;
  if (moved && flips(kept_corners_, k, r, candidate.position)) return false;
  const std::size_t first_merge = merges_.size();
  pairs_.clear();
  kept_wedges_.clear();
  if (!state_.wedges.empty() && !pair_wedges(candidate, moved)) return false;
  const float error = plane_distance(candidate);
  commit(candidate, moved, first_merge);
  steps_.push_back({state_.original[k], state_.original[r], candidate.position, candidate.cost, error,
                    static_cast<std::uint32_t>(first_merge), static_cast<std::uint32_t>(merges_.size() - first_merge),
                    static_cast<std::uint32_t>(shared_), moved});
  return true;
}

}  // namespace lodestone::simplify::detail
