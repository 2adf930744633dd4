// The sweep of a range of vertices: one collapse after the other, each checked against the mesh as it is at that moment
// (docs/papers/edge-collapse.md, "The sweep").
//
// run() takes candidates from a queue of cost bins, first in, first out within a bin. A candidate has the cost of when
// it was put there. try_collapse() looks at it again:
// 1. If a vertex has merged into one of its ends since, it is dropped: that collapse has queued the new edges. If only
//    the ring has changed, refresh() evaluates it anew, and puts it back if it has become dearer.
// 2. link_allows(): the link condition [dey-1999]. flips(): no triangle turns too far or becomes a needle. folds(): no
//    new fold ([progressive-mesh], section 3.2).
// 3. error_after() (accumulated_error.cpp): the accumulated error, which can raise the cost.
// 4. pair_wedges(), blend_wedges(), turns_textures() (wedges.cpp): what becomes of attributes, and what that costs.
// 5. If the cost now belongs to a later bin, the candidate goes back. Otherwise record() writes the step, apply()
//    changes the mesh, and add_new_edges() queues the new vertex's edges.
//
// A sweep changes only what lies in its zone, so sweeps of other ranges can run beside it. Its order depends on costs
// and on the order of entry alone: the same for any number of threads. O(valence) a candidate as a rule; kMaxValence
// bounds the worst case.
#include <algorithm>
#include <cmath>

#include "lodestone/base/memory.h"
#include "lodestone/simplify/collapse/sweep_detail.h"

namespace lodestone::simplify::detail {

namespace {

// A surviving triangle may turn by at most about 78 degrees.
constexpr float kMinTurnCosineSq = 0.2F * 0.2F;

// A triangle that turns by less than some 8 degrees is taken not to fold over.
constexpr float kTurnsLittleSq = 0.98F;

// No triangle may get an angle this small (0.06 degrees; sine squared) or this near 180 at the moved corner while it
// shrinks: it would be without area once positions are rounded.
constexpr float kNeedleSineSq = 1e-6F;

}  // namespace

std::span<const Corner> gather(const State& state, std::uint32_t v, std::vector<Corner>& memory) {
  static constexpr std::uint32_t kNext[4] = {1, 2, 0, 1};
  const std::span<const std::uint32_t> star = state.star_of(v);
  if (memory.size() < star.size()) memory.resize(2 * star.size());
  Corner* out = memory.data();
  for (const std::uint32_t entry : star) {
    const std::uint32_t t = entry >> 2, k = entry & 3;
    const Triangle& c = state.triangles[t];
    *out++ = {c[kNext[k]], c[kNext[k + 1]], t};
  }
  return std::span<const Corner>(memory).first(star.size());
}

Sweeper::Sweeper(State& state, std::uint8_t zone, float max_cost, std::uint32_t first_collapse,
                 std::uint32_t first_mark)
    : state_(state),
      zone_(zone),
      max_cost_(max_cost),
      fold_cosine_sq_(state.fold_cosine * state.fold_cosine),
      collapse_(first_collapse),
      mark_(first_mark),
      evaluator_(state),
      bin_(kBins),
      fan_(state.rounding) {}

void Sweeper::push(const Candidate& candidate, float cost) {
  if (bin_head_.empty()) {
    bin_head_.assign(kBins, kNone);
    bin_tail_.assign(kBins, kNone);
  }
  const std::uint32_t bin = bin_of(cost), entry = static_cast<std::uint32_t>(queue_.size());
  queue_.push_back(candidate);
  queue_next_.push_back(kNone);
  (bin_head_[bin] == kNone ? bin_head_[bin] : queue_next_[bin_tail_[bin]]) = entry;
  bin_tail_[bin] = entry;
  bin_ = std::min<std::size_t>(bin_, bin);
}

void Sweeper::enqueue() {
  for (Candidate& c : evaluator_.finish()) {
    if (!is_possible(c.cost, max_cost_)) continue;
    c.stamp = collapse_;
    push(c, c.cost);
  }
  evaluator_.clear();
}

void Sweeper::run(const Task& task) {
  enqueue();
  for (; bin_ < kBins; ++bin_) {
    if (task.cancelled()) return;
    while (bin_ < kBins && bin_head_[bin_] != kNone) {
      const std::uint32_t entry = bin_head_[bin_];
      bin_head_[bin_] = queue_next_[entry];
      try_collapse(queue_[entry]);
    }
  }
  free_memory(queue_, queue_next_, bin_head_, bin_tail_);  // what is kept until all have swept is the record alone
  steps_.shrink_to_fit();
  merges_.shrink_to_fit();
}

// Brings a candidate up to date when a star around it has changed. False = not now: dropped, or back in the queue.
bool Sweeper::refresh(Candidate& candidate) {
  const Notes &kept = state_.notes[candidate.kept], &removed = state_.notes[candidate.removed];
  if (kept.touched_at <= candidate.stamp && removed.touched_at <= candidate.stamp) return true;
  renew(candidate.kept);
  renew(candidate.removed);
  evaluator_.add_edge(candidate.kept, candidate.removed, removed_);
  const std::vector<Candidate>& now = evaluator_.finish();
  const bool possible = !now.empty() && is_possible(now[0].cost, max_cost_);
  if (possible) {
    candidate.position = now[0].position;
    candidate.cost = now[0].cost;
    candidate.stamp = collapse_;
  }
  evaluator_.clear();
  if (!possible) return false;
  if (bin_of(candidate.cost) <= bin_) return true;
  push(candidate, candidate.cost);
  return false;
}

// Link condition (Dey et al. 1999): the vertices adjacent to both ends are just the third corners of the edge's
// triangles, and no two triangles fall together; something must be left, so that no closed piece falls below four
// vertices, no open one below three.
bool Sweeper::link_allows(const Candidate& candidate) {
  std::vector<Notes>& notes = state_.notes;
  const std::uint32_t around = mark_ + 1, both = mark_ + 2, opposite = mark_ + 3;
  mark_ += 3;
  for (const Corner& c : kept_) notes[c.a].mark = notes[c.b].mark = around;
  shared_ = 0;
  std::size_t common = 0, thirds = 0;
  for (const Corner& c : removed_) {
    for (const std::uint32_t u : {c.a, c.b}) {
      if (u == candidate.kept || notes[u].mark != around) continue;
      notes[u].mark = both;
      ++common;
    }
  }
  for (const Corner& c : removed_) {
    if (c.a != candidate.kept && c.b != candidate.kept) continue;
    ++shared_;
    const std::uint32_t third = c.a == candidate.kept ? c.b : c.a;
    if (notes[third].mark != both) continue;
    notes[third].mark = opposite;
    ++thirds;
  }
  if (shared_ == 0 || common != thirds) return false;
  if (removed_.size() + kept_.size() == 2 * shared_) return false;
  const auto between_thirds = [&](const Corner& c) {
    return notes[c.a].mark == opposite && notes[c.b].mark == opposite;
  };
  for (const Corner& r : removed_) {
    if (!between_thirds(r)) continue;
    for (const Corner& k : kept_) {
      if (between_thirds(k) && ((k.a == r.a && k.b == r.b) || (k.a == r.b && k.b == r.a))) return false;
    }
  }
  return true;
}

// The triangles around the new vertex go to corners_, their normals to normals_. True if one of them turns over or
// becomes a needle.
bool Sweeper::flips(const Candidate& candidate, bool moved) {
  corners_.clear();
  normals_.clear();
  turns_.clear();
  const Vec3f to = candidate.position;
  const auto turns = [&](std::span<const Corner> corners, std::uint32_t other, bool moves) {
    for (const Corner& c : corners) {
      if (c.a == other || c.b == other) continue;
      const Vec3f before = state_.normals[c.triangle].n;
      corners_.push_back(c);
      normals_.push_back(before);
      turns_.push_back(0);
      if (!moves) continue;
      const Vec3f a = state_.positions[c.a] - to, b = state_.positions[c.b] - to, after = cross(a, b);
      normals_.back() = after;
      const float before_sq = length_sq(before), after_sq = length_sq(after);
      if (before_sq == 0) continue;
      const float d = dot(before, after);
      const float squares = before_sq * after_sq;
      if (!(d > 0 && d * d > kMinTurnCosineSq * squares)) return true;
      const PackedDirection first = state_.first_normals[c.triangle];
      if (first.dot(after) < 0 && first.dot(before) >= 0) return true;  // it has turned over in small steps
      turns_.back() = d * d > kTurnsLittleSq * squares ? 0 : 1;
      if (after_sq < kNeedleSineSq * length_sq(a) * length_sq(b) && after_sq < before_sq) return true;
    }
    return false;
  };
  return turns(kept_, candidate.removed, moved) || turns(removed_, candidate.kept, true);
}

// True if two triangles with these normals face each other closer than the limit.
bool Sweeper::is_fold(Vec3f n, Vec3f m) const {
  const float d = dot(n, m);
  return d < 0 && d * d > fold_cosine_sq_ * length_sq(n) * length_sq(m);
}

// True if two neighbours around a vertex do. normals(i) is that of corner i.
template <class Normals>
bool Sweeper::has_fold(std::span<const Corner> corners, Normals normals) const {
  Fan fan;
  if (!fan.load(corners)) return false;
  for (std::uint32_t i = 0; i < corners.size(); ++i) {
    const std::uint32_t before = fan.before(corners[i].a);
    if (before != kNone && is_fold(normals(i), normals(before))) return true;
  }
  return false;
}

// True if a triangle that turns folds over the edge that lies across the new vertex.
bool Sweeper::folds_outwards() const {
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    if (turns_[i] == 0) continue;
    const Corner& c = corners_[i];
    const Vec3f before = state_.normals[c.triangle].n, after = normals_[i];
    bool fold = false;
    for (const std::uint32_t entry : state_.star_of(c.a)) {
      const std::uint32_t t = entry >> 2;
      const Triangle& v = state_.triangles[t];
      if (t == c.triangle || (v[0] != c.b && v[1] != c.b && v[2] != c.b)) continue;
      fold = fold || (is_fold(state_.normals[t].n, after) && !is_fold(state_.normals[t].n, before));
    }
    if (fold) return true;
  }
  return false;
}

// True if the collapse folds the surface where it was not ([progressive-mesh], 3.2: no dihedral angle below a limit).
bool Sweeper::folds() const {
  if (folds_outwards()) return true;
  if (!has_fold(corners_, [&](std::size_t i) { return normals_[i]; })) return false;
  for (const std::span<const Corner> corners : {kept_, removed_}) {
    if (has_fold(corners, [&](std::size_t i) { return state_.normals[corners[i].triangle].n; })) return false;
  }
  return true;
}

// Appends to the record.
void Sweeper::record(const Candidate& candidate, bool moved, float error) {
  Step step;
  step.kept = state_.original[candidate.kept];
  step.removed = state_.original[candidate.removed];
  step.position = candidate.position;
  step.error = error;
  step.first_wedge = static_cast<std::uint32_t>(merges_.size());
  step.wedge_count = static_cast<std::uint32_t>(merging_.size());
  merges_.insert(merges_.end(), merging_.begin(), merging_.end());
  step.faces = static_cast<std::uint32_t>(shared_);
  for (const Corner& c : removed_) {
    const bool vanishes = c.a == candidate.kept || c.b == candidate.kept;
    if (vanishes && !state_.has_back.empty()) step.faces += state_.has_back[c.triangle];
  }
  step.moved = moved;
  // Steps that this one builds on have left their places in the order at the vertices around.
  step.order = bin_of(candidate.cost);
  for (const std::span<const Corner> corners : {kept_, removed_}) {
    for (const Corner& c : corners) {
      step.order = std::max<std::uint32_t>({step.order, state_.notes[c.a].order, state_.notes[c.b].order});
    }
  }
  steps_.push_back(step);
}

void Sweeper::leave_star(std::uint32_t v, std::uint32_t triangle) {
  StarRef& star = state_.stars[v];
  for (std::uint32_t i = 0; i < star.count; ++i) {
    if (star.entries[i] >> 2 != triangle) continue;
    star.entries[i] = star.entries[--star.count];
    return;
  }
}

// The star of the new vertex, whose triangles know it by now.
void Sweeper::join_stars(std::uint32_t kept, std::uint32_t removed) {
  StarRef &star = state_.stars[kept], &other = state_.stars[removed];
  const auto size = static_cast<std::uint32_t>(corners_.size());
  if (star.capacity < size) std::swap(star, other);
  if (star.capacity < size) {
    star.capacity = size + 4;
    star.entries = arena_.take(star.capacity);
  }
  star.count = size;
  other.count = 0;
  for (std::uint32_t i = 0; i < size; ++i) {
    const Triangle& c = state_.triangles[corners_[i].triangle];
    star.entries[i] = corners_[i].triangle << 2 | (c[0] == kept ? 0U : c[1] == kept ? 1U : 2U);
  }
}

// Changes the mesh.
void Sweeper::apply(const Candidate& candidate, bool moved) {
  const std::uint32_t k = candidate.kept, r = candidate.removed;
  ++collapse_;
  ++mark_;
  if (moved) state_.positions[k] = candidate.position;
  const std::size_t blocks = state_.attributes.blocks;
  for (std::size_t i = 0; i < kept_wedges_.size() && blocks > 0; ++i) {
    std::copy_n(merged_values_.begin() + static_cast<std::ptrdiff_t>(i * blocks), blocks,
                state_.attributes.values.begin() + static_cast<std::ptrdiff_t>(kept_wedges_[i] * blocks));
  }
  const auto order = static_cast<std::uint16_t>(steps_.back().order);
  const auto visit = [&](std::uint32_t u) {
    Notes& notes = state_.notes[u];
    if (notes.mark == mark_) return;
    notes = {mark_, collapse_, notes.merged_at, order, true};
  };
  for (const Corner& c : removed_) {
    Triangle& triangle = state_.triangles[c.triangle];
    if (c.a == k || c.b == k) {
      const std::uint32_t third = c.a == k ? c.b : c.a;
      visit(third);
      leave_star(third, c.triangle);
      triangle = {kNone, kNone, kNone};
      state_.normals[c.triangle] = {};
      continue;
    }
    const std::size_t corner = triangle[0] == r ? 0 : triangle[1] == r ? 1 : 2;
    triangle[corner] = k;
    if (!state_.wedges.empty()) {
      std::uint32_t& wedge = state_.wedges[c.triangle][corner];
      wedge = std::find_if(pairs_.begin(), pairs_.end(), [&](const auto& p) { return p.first == wedge; })->second;
    }
  }
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    visit(corners_[i].a);
    visit(corners_[i].b);
    state_.normals[corners_[i].triangle] = weighed_normal(normals_[i]);
  }
  if (!state_.weights.empty()) state_.weights[k] = std::max(state_.weights[k], state_.weights[r]);
  join_stars(k, r);
  state_.notes[r].merged_at = kNone;
  state_.notes[k] = {mark_, collapse_, collapse_, order, true};
  state_.zone[k] &= static_cast<std::uint8_t>(state_.zone[r] | kHeavy);
}

void Sweeper::renew(std::uint32_t vertex) {
  if (!state_.notes[vertex].stale || (state_.zone[vertex] & kHeavy) != 0) return;
  renew_quadric(state_, vertex);
  state_.notes[vertex].stale = false;
}

// The new vertex's edges into the queue.
void Sweeper::add_new_edges(std::uint32_t kept) {
  if (corners_.size() > kMaxValence) return;
  renew(kept);
  for (const Corner& c : corners_) {
    if (may_touch(c.a)) renew(c.a);
    if (may_touch(c.b)) renew(c.b);
  }
  evaluator_.add_edges(kept, corners_, [&](std::uint32_t u) { return may_touch(u); });
  enqueue();
}

void Sweeper::try_collapse(Candidate candidate) {
  const std::uint32_t k = candidate.kept, r = candidate.removed;
  if (state_.notes[k].merged_at > candidate.stamp || state_.notes[r].merged_at > candidate.stamp) return;
  removed_ = gather(state_, r, removed_memory_);
  if (removed_.size() > kMaxValence || !refresh(candidate)) return;
  kept_ = gather(state_, k, kept_memory_);
  if (kept_.size() > kMaxValence || !link_allows(candidate)) return;
  const bool moved = state_.classes[k] == state_.classes[r];
  if (flips(candidate, moved) || folds()) return;
  const float weight = state_.weight_of(k, r), error_scale = state_.error_weight * weight;
  const float accumulated = error_after(candidate, std::sqrt(candidate.cost / error_scale));
  float cost = std::max(candidate.cost, error_scale * accumulated * accumulated);
  float error = accumulated;
  if (!state_.wedges.empty()) {
    if (!pair_wedges(candidate, moved)) return;
    cost += blend_wedges(candidate, moved) * weight;
    if (state_.attributes.blocks > 0) {
      if (turns_textures(candidate)) return;
      error = std::max(error, attribute_error(candidate, moved));
    }
  }
  if (bin_of(cost) > bin_) {  // dearer than the queue knew: its turn comes later
    candidate.stamp = collapse_;
    if (is_possible(cost, max_cost_)) push(candidate, cost);
    return;
  }
  candidate.cost = cost;
  record(candidate, moved, error);
  apply(candidate, moved);
  state_.accumulated_error[k] = accumulated;
  add_new_edges(k);
}

}  // namespace lodestone::simplify::detail
