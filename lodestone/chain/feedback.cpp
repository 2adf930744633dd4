// Method   measured error -> importance weights -> collapse again, the best round kept; then vertices fitted
// Source   docs/papers/measured-feedback.md
#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "lodestone/base/parallel.h"
#include "lodestone/base/units.h"
#include "lodestone/chain/feedback_detail.h"
#include "lodestone/core/adjacency.h"
#include "lodestone/simplify/fit.h"
#include "lodestone/simplify/split_worst.h"
#include "lodestone/spatial/closest_batch.h"

namespace lodestone::chain::detail {

namespace {

using simplify::EdgeCollapseOptions;
using simplify::FittedLevel;

// Weighted rounds: triangles above this share of the maximum are made finer,
constexpr double kBad = 0.7;
constexpr double kMostFactor = 8;    // by so much of a weight in one round at most,
constexpr double kMostWeight = 1e9;  // and in all;
constexpr double kMeanSlack = 1.01;  // the mean may rise by a hundredth for a smaller maximum
constexpr int kWeightedRounds = 2;

// Equalizing rounds: how many at most, and how many without a smaller maximum end them.
constexpr int kRounds = 14;
constexpr int kIdleRounds = 4;
constexpr double kSplit = 0.75;        // of the maximum: triangles above it are split
constexpr double kSplitShare = 0.004;  // of all triangles that may be added a round
constexpr double kRoundsMeanForGoal = 1.15;
constexpr double kGoal = 0.88;        // of the goal: what is found here is no certified bound
constexpr double kRoundsMean = 1.03;  // how far the mean may rise over the fitted one's
constexpr double kHold = 1e4;         // weight of vertices where the level is worst, so that they stay
constexpr int kSolves = 6, kLocalSolves = 3;
constexpr int kRings = 2;  // around what is new: vertices that are fitted again

// Raises the weights of the start's vertices whose closest triangle of the level is among the worst.
void raise_weights(const Mesh& start, const FittedLevel& level, std::vector<float>& weights, const Task& task) {
  const spatial::Surface surface = simplify::surface_of(level.mesh(), task);
  const spatial::Bvh tree(surface, task);
  const std::vector<FittedLevel::Worst> all = level.worst();
  const double limit = kBad * level.max();
  parallel_for(start.vertex_count(), 4096, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    std::vector<Vec3d> points;
    for (std::size_t v = begin; v < end; ++v) points.push_back(start.position(static_cast<std::uint32_t>(v)));
    std::vector<spatial::Nearest> closest(points.size());
    spatial::ClosestBatch(tree).find(points, closest);
    for (std::size_t v = begin; v < end; ++v) {
      const double worst = all[surface.drawn[closest[v - begin].triangle]].distance;
      if (!(worst > limit)) continue;
      const double ratio = worst / limit, factor = std::min(ratio * ratio * ratio * ratio * ratio * ratio, kMostFactor);
      const double raised = std::min(static_cast<double>(weights[v]) * factor, kMostWeight);
      weights[v] = std::max(weights[v], static_cast<float>(raised));
    }
  });
}

// Non-zero for vertices at one of these places (sorted).
std::vector<std::uint8_t> at_places(const Mesh& mesh, const std::vector<Vec3f>& places) {
  std::vector<std::uint8_t> found(mesh.vertex_count(), 0);
  for (std::size_t v = 0; v < found.size(); ++v) {
    found[v] = std::binary_search(places.begin(), places.end(), mesh.positions[v], before) ? 1 : 0;
  }
  return found;
}

// Vertices farther than `rings` edges from those that are new to a mesh.
std::vector<std::uint8_t> far_from_new(const Mesh& mesh, const Mesh& old, int rings) {
  std::vector<Vec3f> known = old.positions;
  std::sort(known.begin(), known.end(), before);
  std::vector<std::uint8_t> far = at_places(mesh, known);
  for (int ring = 0; ring < rings; ++ring) {
    const std::vector<std::uint8_t> last = far;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const Triangle v = mesh.vertices_of(t);
      if (last[v[0]] != 0 && last[v[1]] != 0 && last[v[2]] != 0) continue;
      for (const std::uint32_t x : v) far[x] = 0;
    }
  }
  return far;
}

// One round: triangles where the level is worst, in place of those that are missed least.
Result<FittedLevel> equalized(const ShapeSource& source, const FittedLevel& level, std::size_t most_triangles,
                              const Task& task) {
  const std::size_t triangles = level.mesh().triangles.size();
  const auto most = static_cast<std::size_t>(kSplitShare * static_cast<double>(triangles));
  simplify::SplitResult split =
      simplify::split_worst(level, kSplit, std::max<std::size_t>(2, most), source.options.keep_border,
                            at_places(level.mesh(), source.locked_places), task);
  std::sort(split.pulled.begin(), split.pulled.end(), before);
  EdgeCollapseOptions options = source.options;
  options.target_triangles = most_triangles;
  options.record_log = false;
  options.locked = at_places(split.mesh, source.locked_places);
  options.weights.assign(split.mesh.vertex_count(), 1.0F);
  const std::vector<FittedLevel::Worst> worst = level.worst();
  for (std::size_t t = 0; t < split.mesh.triangles.size(); ++t) {
    const double share = t < triangles ? worst[t].distance / level.max() : 1;
    const auto weight = static_cast<float>(1 + kHold * share * share * share * share);
    for (const std::uint32_t v : split.mesh.vertices_of(t)) options.weights[v] = std::max(options.weights[v], weight);
  }
  Result<simplify::EdgeCollapseResult> made = simplify::collapse_edges(split.mesh, options, task);
  if (!made) return fail(made.error());
  FittedLevel next(source.target, std::move(made->mesh), task, &level);
  simplify::FitOptions fit;
  fit.solves = kLocalSolves;
  fit.locked = far_from_new(next.mesh(), level.mesh(), kRings);
  const std::vector<std::uint8_t> kept = at_places(next.mesh(), source.locked_places);
  const std::vector<std::uint8_t> pulled = at_places(next.mesh(), split.pulled);
  for (std::size_t v = 0; v < fit.locked.size(); ++v) {
    if (kept[v] != 0 || pulled[v] != 0) fit.locked[v] = 1;  // fitting would let those out again that were pulled in
  }
  next.fit(fit, task);
  return next;
}

// The start collapsed again, vertices where the level is worst weighing more; the smallest maximum.
Result<FittedLevel> weighted(const ShapeSource& source, Mesh plain, const Task& task) {
  EdgeCollapseOptions options = source.options;
  options.target_triangles = plain.triangles.size();
  options.record_log = false;
  options.weights.resize(source.start.vertex_count(), 1.0F);
  options.locked = at_places(source.start, source.locked_places);
  FittedLevel best(source.target, std::move(plain), task);
  FittedLevel current = best;
  const double start_mean = best.mean();
  for (int round = 0; round < kWeightedRounds && !task.cancelled(); ++round) {
    raise_weights(source.start, current, options.weights, task);
    Result<simplify::EdgeCollapseResult> made = simplify::collapse_edges(source.start, options, task.part(0.3));
    if (!made) return fail(made.error());
    if (made->mesh.triangles.empty() || task.cancelled()) break;
    current = FittedLevel(source.target, std::move(made->mesh), task);
    if (current.max() < best.max() && current.mean() <= kMeanSlack * start_mean) best = current;
  }
  return best;
}

bool has_borders(const Mesh& mesh, const Task& task) {
  const EdgeTriangles edges = edge_triangles(mesh, task);
  return std::any_of(edges.edges.begin(), edges.edges.end(), [](const Edge& e) { return e.count != 2; });
}

Result<FittedLevel> fitted(const ShapeSource& source, Mesh plain, const Task& task) {
  const std::size_t triangles = plain.triangles.size();
  simplify::FitOptions fit;
  fit.solves = kSolves;
  // Fitting holds borders and what is not manifold; where these are worst, only collapsing otherwise helps.
  FittedLevel best(source.target, std::move(plain), task);
  const double plain_mean = best.mean();
  if (has_borders(best.mesh(), task)) {
    Result<FittedLevel> start = weighted(source, best.mesh(), task);
    if (!start) return start;
    best = std::move(*start);
  }
  if (!source.locked_places.empty()) fit.locked = at_places(best.mesh(), source.locked_places);
  best.fit(fit, task);
  task.advance(0.4);
  // Triangles are not shifted away from where the user wants them.
  if (!source.options.weights.empty()) return best;
  // A maximum that is asked for is worth more rounds, and some of the mean; less of it is worth nothing.
  const bool asked = source.goal > 0;
  const double most_mean = asked ? kRoundsMeanForGoal * best.mean() : std::min(kRoundsMean * best.mean(), plain_mean);
  const int most_rounds = asked ? 2 * kRounds : kRounds, most_idle = asked ? 2 * kIdleRounds : kIdleRounds;
  FittedLevel current = best;
  for (int round = 0, idle = 0; round < most_rounds && idle < most_idle && !task.cancelled(); ++round) {
    if (best.max() < kGoal * source.goal) break;
    const Task part =
        task.part(0.6 / most_rounds, fmt::format("round {}, maximum {}", round + 1, short_number(best.max())));
    Result<FittedLevel> next = equalized(source, current, triangles, part);
    if (!next) return fail(next.error());
    if (next->mesh().triangles.empty() || next->mean() > most_mean || next->mesh().triangles.size() > triangles) break;
    current = std::move(*next);
    ++idle;
    if (!(current.max() < best.max())) continue;
    best = current;
    idle = 0;
  }
  return best;
}

}  // namespace

Result<Mesh> shape_level(const ShapeSource& source, Mesh plain, Effort effort, const Task& task) {
  if (effort == Effort::fast || plain.triangles.empty()) return plain;
  Result<FittedLevel> shaped =
      effort == Effort::normal ? weighted(source, std::move(plain), task) : fitted(source, std::move(plain), task);
  if (task.cancelled()) return cancelled_error("shaping");
  if (!shaped) return fail(shaped.error());
  return shaped->mesh();
}

}  // namespace lodestone::chain::detail
