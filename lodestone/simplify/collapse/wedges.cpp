// What becomes of wedges and their attributes in a collapse: the part of Sweeper that deals with them
// (docs/papers/edge-collapse.md, "Attributes").
//
// 1. pair_wedges(): each wedge of the removed vertex needs a wedge of the kept one that takes over: across the edge's
//    triangles; or, where only normals are split, the one of the same chart with the nearest normal (nearest_normal()).
//    Without such a wedge the edge can't collapse.
// 2. blend_wedges(): the values of the merged wedges. A vertex with one wedge that lies on no feature gets as near as
//    it can to the values that err least, between its own, its partner's and those of a third vertex (blend_one()).
//    Otherwise all wedges go the same share of the way to their partners (blend_all()): along features the share where
//    the new position lies on the edge (share_by_place()), else the one that errs least (share_by_values()).
// 3. attribute_error(): the deviation that this leaves, as a length, for the estimated error of the step.
// 4. turns_textures(): whether a surviving triangle would turn over in a UV set.
//
// Blends are recorded as shares between wedges of the input, so that replay repeats them on the original values, and
// no value leaves the range that the wedges span. What agreed across a hard edge agrees afterwards. O(valence * numbers
// a wedge).
#include <algorithm>
#include <cmath>
#include <limits>

#include "lodestone/simplify/collapse/attributes_detail.h"
#include "lodestone/simplify/collapse/sweep_detail.h"

namespace lodestone::simplify::detail {

std::uint32_t Sweeper::nearest_normal(std::uint32_t wedge, std::uint32_t chart) const {
  std::uint32_t best = kNone;
  float best_cosine = -std::numeric_limits<float>::infinity();
  for (const std::uint32_t k : kept_wedges_) {
    if (state_.chart[k] != chart) continue;
    const float cosine = state_.wedge_normals.empty() ? 0 : dot(state_.wedge_normals[k], state_.wedge_normals[wedge]);
    if (best == kNone || cosine > best_cosine) {
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
  const auto find = [&](std::uint32_t wedge) {
    return std::find_if(pairs_.begin(), pairs_.end(), [&](const auto& p) { return p.first == wedge; });
  };
  pairs_.clear();
  kept_wedges_.clear();
  for (const Corner& c : kept_) {
    const std::uint32_t w = wedge_at(state_, c.triangle, candidate.kept);
    if (std::find(kept_wedges_.begin(), kept_wedges_.end(), w) == kept_wedges_.end()) kept_wedges_.push_back(w);
    if (c.a != candidate.removed && c.b != candidate.removed) continue;
    const std::uint32_t from = wedge_at(state_, c.triangle, candidate.removed);
    const auto known = find(from);
    if (known == pairs_.end()) {
      pairs_.emplace_back(from, w);
    } else if (state_.chart[known->second] != state_.chart[w]) {
      return false;  // one wedge would have to become two
    }
  }
  across_ = pairs_.size();
  for (const Corner& c : removed_) {
    const std::uint32_t from = wedge_at(state_, c.triangle, candidate.removed);
    if (find(from) != pairs_.end()) continue;
    const auto kin = std::find_if(pairs_.begin(), pairs_.begin() + static_cast<std::ptrdiff_t>(across_),
                                  [&](const auto& p) { return state_.chart[p.first] == state_.chart[from]; });
    if (kin == pairs_.begin() + static_cast<std::ptrdiff_t>(across_)) return false;
    pairs_.emplace_back(from, nearest_normal(from, state_.chart[kin->second]));
  }
  if (!moved) return true;
  // A vertex that moves takes all its wedges along, so each needs a partner to blend with.
  return std::all_of(kept_wedges_.begin(), kept_wedges_.end(), [&](std::uint32_t k) {
    return std::any_of(pairs_.begin(), pairs_.end(),
                       [&](const auto& p) { return state_.chart[p.second] == state_.chart[k]; });
  });
}

// Where the new position lies along the edge, 0 to 1.
float Sweeper::share_by_place(const Candidate& candidate) const {
  const Vec3f from = state_.positions[candidate.kept], edge = state_.positions[candidate.removed] - from;
  const float l = length_sq(edge);
  return l > 0 ? std::clamp(dot(candidate.position - from, edge) / l, 0.0F, 1.0F) : 0.0F;
}

// Where along the edge attributes err least, all pairs of wedges together.
float Sweeper::share_by_values(const Candidate& candidate) {
  const AttributeField& field = state_.attributes;
  float along = 0, goal = 0;
  for (const auto& [removed, kept] : pairs_) {
    best_values(state_, {kept, removed, candidate.kept, candidate.removed, true}, candidate.position, wanted_);
    const Projection p = project(field, kept, removed, wanted_);
    along += p.along_along;
    goal += p.along_goal;
  }
  return along > 0 ? std::clamp(goal / along, 0.0F, 1.0F) : share_by_place(candidate);
}

// All wedges go the same share of the way to their partners: what agreed across a hard edge (UVs, skin weights, morph
// targets) agrees afterwards.
void Sweeper::blend_all(float share) {
  if (!(share > 0)) return;
  for (const std::uint32_t wedge : kept_wedges_) {
    const auto same = std::find_if(pairs_.begin(), pairs_.end(), [&](const auto& p) { return p.second == wedge; });
    if (same != pairs_.end()) {
      merging_[static_cast<std::size_t>(same - pairs_.begin())].blend = share;
      continue;
    }
    const auto kin = std::find_if(pairs_.begin(), pairs_.end(),
                                  [&](const auto& p) { return state_.chart[p.second] == state_.chart[wedge]; });
    merging_.push_back({wedge, kin->first, share, false});
  }
}

// The one wedge gets as near as it can to the values that err least, between its own, its partner's and those of a
// third vertex that both ends share.
void Sweeper::blend_one(const Candidate& candidate) {
  WedgeMerge& merge = merging_.front();
  best_values(state_, {merge.kept, merge.removed, candidate.kept, candidate.removed, true}, candidate.position,
              wanted_);
  std::uint32_t thirds[2];
  std::size_t count = 0;
  for (const Corner& c : kept_) {
    if (count == 2 || (c.a != candidate.removed && c.b != candidate.removed)) continue;
    thirds[count++] = wedge_at(state_, c.triangle, c.a == candidate.removed ? c.b : c.a);
  }
  const Blend blend =
      blend_towards(state_.attributes, merge.kept, merge.removed, std::span(thirds).first(count), wanted_);
  merge.blend = blend.to_removed;
  if (blend.third != kNone) merging_.push_back({merge.kept, blend.third, blend.to_third, false});
}

// Fills merging_ and, where attributes have a say, merged_values_. Returns the cost of the pairs that do not lie across
// the edge: the candidate's cost holds those across it already.
float Sweeper::blend_wedges(const Candidate& candidate, bool moved) {
  merging_.clear();
  for (const auto& [removed, kept] : pairs_) merging_.push_back({kept, removed, 0, true});
  const AttributeField& field = state_.attributes;
  // Along a feature both sides have to agree, or what they show would slide apart.
  const bool free = field.blocks > 0 && state_.classes[candidate.kept] == VertexClass::interior;
  wanted_.resize(field.blocks);
  if (moved && free && kept_wedges_.size() == 1 && pairs_.size() == 1) {
    blend_one(candidate);
  } else if (moved) {
    blend_all(free ? share_by_values(candidate) : share_by_place(candidate));
  }
  if (field.blocks == 0) return 0;
  merged_values_.clear();
  for (const std::uint32_t wedge : kept_wedges_) {
    const std::size_t at = merged_values_.size();
    const auto own = field.values.begin() + static_cast<std::ptrdiff_t>(wedge * field.blocks);
    merged_values_.insert(merged_values_.end(), own, own + static_cast<std::ptrdiff_t>(field.blocks));
    for (const WedgeMerge& merge : merging_) {
      if (merge.kept != wedge || !(merge.blend > 0)) continue;
      for (std::size_t b = 0; b < field.blocks; ++b) {
        merged_values_[at + b] +=
            (field.values[merge.removed * field.blocks + b] - merged_values_[at + b]) * merge.blend;
      }
    }
  }
  float more = 0;
  for (std::size_t i = across_; i < pairs_.size(); ++i) {
    more += attribute_cost(state_, {pairs_[i].second, pairs_[i].first, candidate.kept, candidate.removed, moved},
                           candidate.position);
  }
  return more;
}

// Root of the mean squared deviation of attributes, lengths of the working frame, for the pair that errs most.
float Sweeper::attribute_error(const Candidate& candidate, bool moved) const {
  float most = 0;
  for (const auto& [removed, kept] : pairs_) {
    const AttributePair pair{kept, removed, candidate.kept, candidate.removed, moved};
    const float area =
        wedge_weight(state_.attributes, removed) + (moved ? wedge_weight(state_.attributes, kept) : 0.0F);
    if (area > 0) most = std::max(most, attribute_cost(state_, pair, candidate.position) / area);
  }
  return std::sqrt(most);
}

// True if a surviving triangle turns over in a texture.
bool Sweeper::turns_textures(const Candidate& candidate) const {
  const AttributeField& field = state_.attributes;
  if (field.uv_sets == 0) return false;
  const auto own = [&](std::uint32_t wedge) { return &field.values[wedge * field.blocks]; };
  const auto merged = [&](std::uint32_t wedge) {
    const auto found = std::find(kept_wedges_.begin(), kept_wedges_.end(), wedge);
    return &merged_values_[static_cast<std::size_t>(found - kept_wedges_.begin()) * field.blocks];
  };
  const auto turns = [&](const Corner& c, std::uint32_t self) {
    const Triangle& w = state_.wedges[c.triangle];
    const Triangle& v = state_.triangles[c.triangle];
    const Float4* before[3] = {own(w[0]), own(w[1]), own(w[2])};
    const Float4* after[3] = {before[0], before[1], before[2]};
    for (std::size_t k = 0; k < 3; ++k) {
      if (v[k] != self) continue;
      const auto pair = std::find_if(pairs_.begin(), pairs_.end(), [&](const auto& p) { return p.first == w[k]; });
      after[k] = merged(self == candidate.removed ? pair->second : w[k]);
    }
    for (std::size_t set = 0; set < field.uv_sets; ++set) {
      if (turns_uv(set, before, after)) return true;
    }
    return false;
  };
  for (const Corner& c : kept_) {
    if (c.a != candidate.removed && c.b != candidate.removed && turns(c, candidate.kept)) return true;
  }
  for (const Corner& c : removed_) {
    if (c.a != candidate.kept && c.b != candidate.kept && turns(c, candidate.removed)) return true;
  }
  return false;
}

}  // namespace lodestone::simplify::detail
