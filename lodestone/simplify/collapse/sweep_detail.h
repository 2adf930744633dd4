// The sweep of a range of vertices, and the pass that it is part of.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "lodestone/base/task.h"
#include "lodestone/simplify/collapse/accumulated_error_detail.h"
#include "lodestone/simplify/collapse/candidates_detail.h"

namespace lodestone::simplify::detail {

/// Takes the cheapest edge from its queue, collapses it and puts the edges that this changes back, until none is left
/// that costs at most max_cost. One object a range of vertices.
class Sweeper {
 public:
  /// Sweeps edges between vertices that have a bit of `zone`, so that others can sweep other ranges at the same time;
  /// 0 = all edges. Collapses and marks are counted on from those of earlier sweeps.
  Sweeper(State& state, std::uint8_t zone, float max_cost, std::uint32_t first_collapse, std::uint32_t first_mark);

  /// Puts the edges from v to those neighbours u for which wanted(u) into the queue.
  template <class Wanted>
  void add_edges(std::uint32_t v, Wanted wanted) {
    if ((state_.zone[v] & kHeavy) != 0) return;
    evaluator_.add_edges(v, gather(state_, v, kept_memory_), wanted);
    if (evaluator_.size() >= 64) enqueue();
  }
  void run(const Task& task);

  const std::vector<Step>& steps() const { return steps_; }
  const std::vector<WedgeMerge>& merges() const { return merges_; }
  std::uint32_t collapses() const { return collapse_; }  ///< with those before this sweep
  std::uint32_t last_mark() const { return mark_; }

 private:
  bool may_touch(std::uint32_t v) const { return (state_.zone[v] & zone_) == zone_; }
  void enqueue();
  void push(const Candidate& candidate, float cost);
  void try_collapse(Candidate candidate);
  bool refresh(Candidate& candidate);
  bool link_allows(const Candidate& candidate);
  bool flips(const Candidate& candidate, bool moved);
  bool is_fold(Vec3f n, Vec3f m) const;
  bool folds_outwards() const;
  bool folds() const;
  template <class Normals>
  bool has_fold(std::span<const Corner> corners, Normals normals) const;
  bool pair_wedges(const Candidate& candidate, bool moved);
  std::uint32_t nearest_normal(std::uint32_t wedge, std::uint32_t chart) const;
  float error_after(const Candidate& candidate, float enough);
  void record(const Candidate& candidate, bool moved, float error);
  float blend_wedges(const Candidate& candidate, bool moved);
  float share_by_place(const Candidate& candidate) const;
  float share_by_values(const Candidate& candidate);
  void blend_all(float share);
  void blend_one(const Candidate& candidate);
  float attribute_error(const Candidate& candidate, bool moved) const;
  bool turns_textures(const Candidate& candidate) const;
  void apply(const Candidate& candidate, bool moved);
  void leave_star(std::uint32_t v, std::uint32_t triangle);
  void join_stars(std::uint32_t kept, std::uint32_t removed);
  void renew(std::uint32_t vertex);
  void add_new_edges(std::uint32_t kept);

  State& state_;
  std::uint8_t zone_;
  float max_cost_, fold_cosine_sq_;
  std::uint32_t collapse_, mark_;
  EdgeEvaluator evaluator_;

  // The queue: first in, first out within a bin, so that flats are thinned evenly.
  std::vector<Candidate> queue_;
  std::vector<std::uint32_t> queue_next_, bin_head_, bin_tail_;
  std::size_t bin_ = 0;

  // The collapse at hand.
  std::size_t shared_ = 0;  // triangles that vanish
  std::span<const Corner> kept_, removed_;
  std::vector<Corner> kept_memory_, removed_memory_, corners_;  // corners_: of the new vertex,
  FanDistance fan_;
  std::vector<Vec3f> normals_;                                  // whose triangles get these normals,
  std::vector<std::uint8_t> turns_;                             // non-zero where that turns them more than a little
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs_;  // wedge of removed, wedge of kept
  std::size_t across_ = 0;                                      // of these, how many are across the edge's triangles
  std::vector<std::uint32_t> kept_wedges_;
  std::vector<WedgeMerge> merging_;    // the wedges' part of the record
  std::vector<Float4> merged_values_;  // of the kept wedges afterwards
  std::vector<Float4> wanted_;         // scratch: values that err least

  StarArena arena_;
  std::vector<Step> steps_;
  std::vector<WedgeMerge> merges_;
};

/// One pass: costs of all edges, about the cheapest `share` of them and what comes of these collapsed in order. Appends
/// what was done to `steps` and `merges` and compacts the mesh. Returns the number of collapses.
std::size_t run_pass(State& state, double share, std::vector<Step>& steps, std::vector<WedgeMerge>& merges,
                     const Task& task);

}  // namespace lodestone::simplify::detail
