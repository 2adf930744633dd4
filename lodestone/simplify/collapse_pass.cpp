// One pass: quadrics, costs, the cheapest edges in order, compaction.
//
// Each range of vertices sweeps the edges whose two rings lie in it, in parallel; then one sweep takes the edges that
// cross ranges. The ranges' collapses do not meet, so they can be told in order of cost afterwards: any prefix of the
// record is a mesh from which the cheapest edges are gone everywhere.
#include <algorithm>
#include <bit>
#include <limits>

#include "lodestone/base/parallel.h"
#include "lodestone/simplify/collapse_state_detail.h"

namespace lodestone::simplify::detail {

namespace {

using Histogram = std::vector<std::uint32_t>;

// A range of vertices, its candidates, and those that only the last sweep may take.
struct Range {
  std::uint32_t begin = 0, end = 0;
  std::vector<Candidate> candidates;
  Histogram histogram;
  std::vector<std::uint32_t> order;     // candidates by cost, the range's own
  std::vector<std::uint32_t> crossing;  // candidates that reach into other ranges, by cost
  std::vector<Step> steps;
  std::vector<WedgeMerge> merges;
  std::uint32_t last_stamp = 0;
};

void prepare(State& state, const Task& task) {
  build_stars(state, task);
  const std::size_t n = state.positions.size();
  state.remap.resize(n);
  state.done.assign(n, 0);
  state.touched.assign(n, 0);
  state.mark.assign(n, 0);
  parallel_for(n, 4096, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t v = begin; v < end; ++v) state.remap[v] = static_cast<std::uint32_t>(v);
  });
  compute_quadrics(state, task);
}

// The bin that the cheapest `wanted` candidates end in.
std::size_t cutoff_bin(const std::vector<Range>& ranges, std::size_t wanted) {
  std::size_t sum = 0;
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    for (const Range& range : ranges) sum += range.histogram[bin];
    if (sum >= wanted) return bin;
  }
  return kBins - 1;
}

// Counting sort of the candidates up to the cutoff, the range's own and the crossing ones apart.
void sort_candidates(Range& range, const std::vector<std::uint8_t>& inner, std::size_t cutoff) {
  Histogram own(cutoff + 2, 0), cross(cutoff + 2, 0);
  const auto is_own = [&](const Candidate& c) {
    return inner[c.kept] != 0 && inner[c.removed] != 0 && std::max(c.kept, c.removed) < range.end;
  };
  for (const Candidate& c : range.candidates) {
    const std::size_t bin = bin_of(c.cost);
    if (bin <= cutoff) ++(is_own(c) ? own : cross)[bin + 1];
  }
  for (std::size_t b = 0; b <= cutoff; ++b) {
    own[b + 1] += own[b];
    cross[b + 1] += cross[b];
  }
  range.order.resize(own[cutoff + 1]);
  range.crossing.resize(cross[cutoff + 1]);
  for (std::uint32_t i = 0; i < range.candidates.size(); ++i) {
    const Candidate& c = range.candidates[i];
    const std::size_t bin = bin_of(c.cost);
    if (bin > cutoff) continue;
    if (is_own(c)) {
      range.order[own[bin]++] = i;
    } else {
      range.crossing[cross[bin]++] = i;
    }
  }
}

void sweep_range(State& state, Range& range, float max_cost) {
  Sweeper sweeper(state, 1);
  for (const std::uint32_t i : range.order) sweeper.try_collapse(range.candidates[i], max_cost);
  range.steps = std::move(sweeper.steps());
  range.merges = std::move(sweeper.merges());
  range.last_stamp = sweeper.stamp();
}

void append_step(const Step& step, const std::vector<WedgeMerge>& from, std::vector<Step>& steps,
                 std::vector<WedgeMerge>& merges) {
  steps.push_back(step);
  steps.back().first_wedge = static_cast<std::uint32_t>(merges.size());
  const auto first = from.begin() + step.first_wedge;
  merges.insert(merges.end(), first, first + step.wedge_count);
}

// All ranges' steps by the bin of their cost, ranges in order within a bin; a range's own order stays.
void merge_steps(const std::vector<Range>& ranges, std::vector<Step>& steps, std::vector<WedgeMerge>& merges) {
  // A step may cost less than one before it in its range (re-evaluated): it is told with its predecessor's bin.
  std::vector<std::uint32_t> start(kBins + 1, 0);
  const auto each = [&](auto&& use) {
    for (const Range& range : ranges) {
      std::size_t bin = 0;
      for (const Step& step : range.steps) {
        bin = std::max(bin, bin_of(step.cost));
        use(bin, range, step);
      }
    }
  };
  each([&](std::size_t bin, const Range&, const Step&) { ++start[bin + 1]; });
  for (std::size_t b = 0; b < kBins; ++b) start[b + 1] += start[b];
  struct Place {
    const Range* range;
    const Step* step;
  };
  std::vector<Place> places(start[kBins]);
  each([&](std::size_t bin, const Range& range, const Step& step) { places[start[bin]++] = {&range, &step}; });
  for (const Place& place : places) append_step(*place.step, place.range->merges, steps, merges);
}

void sweep_crossing(State& state, std::vector<Range>& ranges, float max_cost, std::vector<Step>& steps,
                    std::vector<WedgeMerge>& merges) {
  struct Place {
    std::uint32_t bin, range, candidate;
  };
  std::vector<Place> places;
  std::uint32_t stamp = 1;
  for (std::uint32_t r = 0; r < ranges.size(); ++r) {
    stamp = std::max(stamp, ranges[r].last_stamp);
    for (const std::uint32_t i : ranges[r].crossing) {
      places.push_back({static_cast<std::uint32_t>(bin_of(ranges[r].candidates[i].cost)), r, i});
    }
  }
  std::stable_sort(places.begin(), places.end(), [](const Place& a, const Place& b) { return a.bin < b.bin; });
  Sweeper sweeper(state, stamp);
  for (const Place& p : places) sweeper.try_collapse(ranges[p.range].candidates[p.candidate], max_cost);
  for (const Step& step : sweeper.steps()) append_step(step, sweeper.merges(), steps, merges);
}

// Wedges follow their vertices; in the order of the record, as a wedge ends once at the most in a pass.
void rename_wedges(State& state, const std::vector<WedgeMerge>& merges, std::size_t first) {
  if (state.wedges.empty()) return;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> renamed;
  for (std::size_t i = first; i < merges.size(); ++i) {
    if (merges[i].ends) renamed.emplace_back(merges[i].removed, merges[i].kept);
  }
  std::sort(renamed.begin(), renamed.end());
  for (std::size_t t = 0; t < state.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (state.remap[state.triangles[t][k]] == state.triangles[t][k]) continue;
      std::uint32_t& w = state.wedges[t][k];
      const auto found = std::lower_bound(renamed.begin(), renamed.end(), std::pair{w, 0U});
      if (found != renamed.end() && found->first == w) w = found->second;
    }
  }
}

void compact(State& state, const Task& task) {
  const std::size_t n = state.positions.size();
  std::vector<std::uint32_t> name(n);
  std::uint32_t next = 0;
  for (std::uint32_t v = 0; v < n; ++v) {
    if (state.remap[v] != v) continue;
    name[v] = next;
    state.positions[next] = state.positions[v];
    state.classes[next] = state.classes[v];
    state.original[next] = state.original[v];
    ++next;
  }
  state.positions.resize(next);
  state.classes.resize(next);
  state.original.resize(next);
  std::size_t kept = 0;
  for (std::size_t t = 0; t < state.triangles.size(); ++t) {
    const Triangle& c = state.triangles[t];
    const std::uint32_t i = state.remap[c[0]], j = state.remap[c[1]], k = state.remap[c[2]];
    if (i == j || j == k || k == i) continue;
    state.triangles[kept] = {name[i], name[j], name[k]};
    if (!state.wedges.empty()) state.wedges[kept] = state.wedges[t];
    if (!state.groups.empty()) state.groups[kept] = state.groups[t];
    ++kept;
  }
  state.triangles.resize(kept);
  if (!state.wedges.empty()) state.wedges.resize(kept);
  if (!state.groups.empty()) state.groups.resize(kept);
  static_cast<void>(task);
}

}  // namespace

std::size_t vertices_per_range(std::size_t vertices) {
  constexpr std::size_t kSmallest = 2048, kMost = 64;
  return std::max(kSmallest, (vertices + kMost - 1) / kMost);
}

std::size_t run_pass(State& state, double share, std::vector<Step>& steps, std::vector<WedgeMerge>& merges,
                     const Task& task) {
  prepare(state, task);
  const std::size_t n = state.positions.size(), size = vertices_per_range(n);
  std::vector<Range> ranges((n + size - 1) / size);
  for (std::size_t r = 0; r < ranges.size(); ++r) {
    ranges[r].begin = static_cast<std::uint32_t>(r * size);
    ranges[r].end = static_cast<std::uint32_t>(std::min(n, (r + 1) * size));
  }
  parallel_for(ranges.size(), 1, task, [&](std::size_t r, std::size_t, std::size_t) {
    Range& range = ranges[r];
    collect_candidates(state, range.begin, range.end, range.candidates);
    range.histogram.assign(kBins, 0);
    for (const Candidate& c : range.candidates) ++range.histogram[bin_of(c.cost)];
  });
  std::size_t total = 0;
  for (const Range& range : ranges) total += range.candidates.size();
  if (total == 0 || task.cancelled()) return 0;
  const auto wanted = std::max<std::size_t>(1, static_cast<std::size_t>(static_cast<double>(total) * share));
  const std::size_t cutoff = cutoff_bin(ranges, wanted);
  // The upper end of the cutoff bin: what is re-evaluated beyond it waits for the next pass.
  float max_cost = std::numeric_limits<float>::max();
  if (share < 1 && cutoff + 1 < kBins - 8) {
    const auto bits = static_cast<std::uint32_t>((cutoff + 1) << 20);
    max_cost = std::bit_cast<float>(bits);
  }
  parallel_for(ranges.size(), 1, task, [&](std::size_t r, std::size_t, std::size_t) {
    sort_candidates(ranges[r], state.inner, cutoff);
    sweep_range(state, ranges[r], max_cost);
  });
  if (task.cancelled()) return 0;
  const std::size_t before = steps.size(), merges_before = merges.size();
  merge_steps(ranges, steps, merges);
  sweep_crossing(state, ranges, max_cost, steps, merges);
  rename_wedges(state, merges, merges_before);
  compact(state, task);
  return steps.size() - before;
}

}  // namespace lodestone::simplify::detail
