// Edge collapse, cheap edges first, down to a number of triangles or up to an estimated error.
//
// Costs and positions follow [lindstrom-turk-1998]: memoryless and volume-preserving, from quadrics as in
// [garland-heckbert-1997]. A legal collapse keeps the topology (the link condition, [dey-1999]) and turns no triangle
// over. What differs from the papers: docs/papers/edge-collapse.md.
//
// collapse_edges():
// 1. make_state() (state.cpp) builds a working mesh of flat arrays.
// 2. run_passes() calls run_pass() (pass.cpp) until the target is met. Each pass collapses about the cheapest half of
//    the edges (kShare) all over the mesh; sweeps take the edges of a range of vertices from queues by cost. A pass
//    that collapses little doubles the share. When nothing is left at all, narrow folds are allowed (kBladeCosine).
// 3. make_log() turns the steps into a CollapseLog, whose positions are in mesh space and whose errors never fall.
// 4. find_prefix() finds how much of it meets the targets, and replay() makes the mesh from that.
//
// The order of steps depends neither on the targets nor on the number of threads: any level is a prefix of the log.
// Closed manifold input stays closed and manifold. The input mesh is not changed. A pass takes linear time and removes
// a share of what is left, as long as there is something legal to remove: O(n log n) or better.
#include "lodestone/simplify/collapse/edge_collapse.h"
#include "lodestone/base/memory.h"

#include <algorithm>
#include <cmath>

#include "lodestone/core/validate.h"
#include "lodestone/simplify/collapse/sweep_detail.h"

namespace lodestone::simplify {

using detail::State;
using detail::Step;

const char* to_string(StopReason reason) {
  switch (reason) {
    case StopReason::reached_target:
      return "reached_target";
    case StopReason::error_limit:
      return "error_limit";
    case StopReason::no_legal_collapse:
      return "no_legal_collapse";
  }
  return "";
}

namespace {

// Share of the edges that are cheap enough for a pass. Within a range of vertices the order is that of cost whatever
// the share is; edges across ranges lag a pass behind. Mean error at 10 % of eight meshes, over CGAL Lindstrom-Turk's:
// 0.3 1.000, 0.5 1.001, 0.65 1.009, 0.8 1.004; more than 0.5 saves no time, as more is done past the target.
constexpr double kShare = 0.5;

Result<void> check(const Mesh& mesh, const EdgeCollapseOptions& options) {
  const auto bad = [](const char* what, const char* remedy) {
    return fail(ErrorCode::bad_argument, what, "edge collapse", remedy);
  };
  if (options.target_triangles == 0 && !(options.max_error < std::numeric_limits<double>::infinity())) {
    return bad("neither a triangle count nor an error is asked for", "set target_triangles or max_error");
  }
  if (!(options.max_error >= 0)) return bad("the error limit is negative or not a number", "use 0 or more");
  if (mesh.triangles.size() > detail::kMaxTriangles) {
    return bad("the mesh has more triangles than can be handled", "split it into parts below 2^30 triangles");
  }
  if (!options.no_move.empty() && options.no_move.size() != mesh.vertex_count()) {
    return bad("the list of locked vertices has another length than the mesh's vertices", "give one entry a vertex");
  }
  if (!options.weights.empty() && options.weights.size() != mesh.vertex_count()) {
    return bad("the list of weights has another length than the mesh's vertices", "give one entry a vertex");
  }
  const bool usable =
      std::all_of(options.weights.begin(), options.weights.end(), [](float w) { return w >= 0 && std::isfinite(w); });
  if (!usable) return bad("a weight is negative or not finite", "use 0 or more; lock what must stay");
  const auto& metric = options.metric.m;
  if (!std::all_of(metric.begin(), metric.end(), [](double m) { return std::isfinite(m); })) {
    return bad("the metric is not finite", "give a transform, or the identity");
  }
  return {};
}

// A dihedral angle of 0.1 degrees.
constexpr float kBladeCosine = 0.9999985F;

struct Run {
  std::vector<Step> steps;
  std::vector<WedgeMerge> merges;
};

// Passes until the count or the error limit is passed, or nothing collapses any more. Neither of them has a say in the
// order of the steps.
Run run_passes(State& state, const EdgeCollapseOptions& options, const Task& task) {
  Run run;
  run.steps.reserve(state.positions.size());  // what is not used is never touched, and so costs nothing
  const auto left = [&] { return state.triangles.size() + state.backs; };
  const double start = static_cast<double>(left());
  double reported = 0;
  double share = kShare;
  const auto error_limit = static_cast<float>(options.max_error / state.scale);
  while (left() > options.target_triangles && !task.cancelled()) {
    const std::size_t vertices = state.positions.size(), before = run.steps.size();
    const std::size_t collapses = detail::run_pass(state, share, run.steps, run.merges, task);
    const double done = 1 - static_cast<double>(left()) / std::max(1.0, start);
    task.advance(std::max(0.0, done - reported));
    reported = std::max(reported, done);
    const bool over = std::any_of(run.steps.begin() + static_cast<std::ptrdiff_t>(before), run.steps.end(),
                                  [&](const Step& s) { return s.error > error_limit; });
    if (over) break;
    if (collapses == 0 && share >= 1) {
      // Thin bars and plates have no other way left than to end in a blade.
      if (state.fold_cosine >= kBladeCosine) break;
      state.fold_cosine = kBladeCosine;
    }
    if (collapses * 50 < vertices) share = std::min(1.0, share * 2);
  }
  return run;
}

// A vertex may move past the largest float where a mesh reaches that far.
Vec3f within_floats(Vec3d p) {
  constexpr double most = std::numeric_limits<float>::max();
  return to_float({std::clamp(p.x, -most, most), std::clamp(p.y, -most, most), std::clamp(p.z, -most, most)});
}

// From steps in the working frame to the lasting record.
CollapseLog make_log(const Mesh& mesh, State& state, Run run) {
  CollapseLog log;
  log.dropped = std::move(state.dropped);
  log.start_triangles = static_cast<std::uint32_t>(mesh.triangles.size() - log.dropped.size());
  log.wedges = std::move(run.merges);
  log.collapses.reserve(run.steps.size());
  std::vector<Vec3f> current = mesh.positions;
  double error = 0;
  for (const Step& step : run.steps) {
    Collapse c;
    c.kept = step.kept;
    c.removed = step.removed;
    c.kept_before = current[step.kept];
    const Vec3d moved = state.metric_inverse.direction(to_double(step.position) * state.scale) + state.center;
    c.position = step.moved ? within_floats(moved) : c.kept_before;
    error = std::max(error, static_cast<double>(step.error) * state.scale);
    c.error = static_cast<float>(error);
    c.first_wedge = step.first_wedge;
    c.faces = step.faces;
    current[step.kept] = c.position;
    log.collapses.push_back(c);
  }
  return log;
}

struct LogPrefix {
  std::size_t count;
  StopReason stop;
};

LogPrefix find_prefix(const CollapseLog& log, const EdgeCollapseOptions& options) {
  const auto within = std::partition_point(log.collapses.begin(), log.collapses.end(), [&](const Collapse& c) {
    return static_cast<double>(c.error) <= options.max_error;
  });
  const auto by_error = static_cast<std::size_t>(within - log.collapses.begin());
  if (options.target_triangles > 0) {
    const std::size_t by_count = log.prefix_for(options.target_triangles);
    if (by_count <= by_error && log.triangles_after(by_count) <= options.target_triangles) {
      return {by_count, StopReason::reached_target};
    }
  }
  return {by_error, by_error < log.collapses.size() ? StopReason::error_limit : StopReason::no_legal_collapse};
}

LockCounts count_locks(const State& state) {
  LockCounts counts;
  for (const std::uint32_t v : state.original) {
    switch (state.causes[v]) {
      case detail::LockCause::none:
        break;
      case detail::LockCause::border:
        ++counts.border;
        break;
      case detail::LockCause::seam_corner:
        ++counts.seam_corner;
        break;
      case detail::LockCause::non_manifold:
        ++counts.non_manifold;
        break;
      case detail::LockCause::by_request:
        ++counts.by_request;
        break;
    }
  }
  return counts;
}

// Frees what the record does not need: most of the memory of a run, whose arrays never shrink.
void release_mesh(State& state) {
  free_memory(state.positions, state.accumulated_error, state.triangles, state.wedges, state.normals,
              state.first_normals, state.quadrics, state.notes, state.classes, state.stars, state.wedge_normals,
              state.weights, state.star_memory, state.groups, state.original, state.chart);
  state.attributes = {};
}

}  // namespace

Result<EdgeCollapseResult> collapse_edges(const Mesh& mesh, const EdgeCollapseOptions& options, Task task) {
  LODESTONE_TRY(check(mesh, options));
  if (options.input != Input::valid) {
    LODESTONE_TRY(validate(mesh, task));
  }
  const Task passes = task.part(0.9);
  Result<State> state = detail::make_state(mesh, options, passes);
  LODESTONE_TRY(state);
  Run run = run_passes(*state, options, passes);
  if (task.cancelled()) return cancelled_error("edge collapse");
  EdgeCollapseResult result;
  result.locked = count_locks(*state);
  release_mesh(*state);
  CollapseLog log = make_log(mesh, *state, std::move(run));
  const LogPrefix prefix = find_prefix(log, options);
  result.stop = prefix.stop;
  if (prefix.count > 0) result.estimated_error = log.collapses[prefix.count - 1].error;
  ReplayOptions replaying;
  replaying.input = Input::valid;
  Result<ReplayResult> replayed = replay(mesh, log, prefix.count, replaying, task);
  LODESTONE_TRY(replayed);
  result.mesh = std::move(replayed->mesh);
  result.origin = std::move(replayed->origin);
  result.vertex_origin = std::move(replayed->vertex_origin);
  if (options.record_log) result.log = std::move(log);
  return result;
}

}  // namespace lodestone::simplify
