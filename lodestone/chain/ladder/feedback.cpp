// Levels improved by their own measured error. Sources and figures: docs/papers/measured-feedback.md.
//
// Edge collapse makes a good level where its costs judged well. Where they did not, the measured error shows it.
// apply_feedback() improves the level in one of two ways:
// - weighted() (effort normal): the start is collapsed again, vertices near the worst triangles weighing more
//   (raise_weights()); two rounds. The idea that measurements choose what is collapsed: [lindstrom-turk-2000].
// - fitted() (effort best): vertices are moved and edges turned to where squared distances are least [hoppe-1993]
//   (fit_without_faults()). redistribute_rounds() then splits triangles where the level is worst and collapses others
//   where that costs least. At last meet_volume() restores the volume.
// With a goal for the error, fewest_within_goal() then removes triangles step by step, a tenth at first. In each step
// within_goal() marks vertices no_collapse where the level came out beyond the goal, and tries again; holds_goal()
// accepts a level only with a certified bound.
//
// Of all rounds the level with the smallest maximum is taken. The mean stays within a limit, and no step adds faults
// (triangles that cross or fold) to those of the plain level; weighted() of effort normal admits as many as the
// original has. A fit may still raise the maximum, so LevelMaker measures both levels and takes the better. Vertices
// are known across levels by name (NamedMesh); lists for no_move and no_collapse hold names.
// The same bytes for any number of threads. O(rounds * n log n).
#include <algorithm>
#include <optional>
#include <tuple>

#include <fmt/format.h>

#include "lodestone/base/parallel.h"
#include "lodestone/base/units.h"
#include "lodestone/chain/ladder/feedback_detail.h"
#include "lodestone/chain/ladder/redistribute_detail.h"
#include "lodestone/core/adjacency.h"
#include "lodestone/core/model.h"
#include "lodestone/simplify/fit/tracked_level.h"
#include "lodestone/spatial/closest_batch.h"
#include "lodestone/spatial/self_intersections.h"

namespace lodestone::chain::detail {

namespace {

using simplify::EdgeCollapseOptions;
using simplify::TrackedLevel;

// Weighted rounds: triangles above this share of the maximum are made finer,
constexpr double kBad = 0.7;
constexpr double kMostFactor = 8;    // by so much of a weight in one round at most,
constexpr double kMostWeight = 1e9;  // and in all;
constexpr double kMeanSlack = 1.01;  // the mean may rise by a hundredth for a smaller maximum
constexpr float kBorder = 3;         // weight of borders, so that they pay little for what gains weight elsewhere
constexpr int kWeightedRounds = 2;

// Redistributing rounds: at most so many, ended by so many in a row without a smaller maximum.
constexpr int kRounds = 14;
constexpr int kIdleRounds = 4;
// Fewer triangles within a goal: the share that the first step leaves, and the share at which steps end.
constexpr double kShrink = 0.9, kLeastShrink = 0.98;
constexpr int kRetries = 4;        // with no_collapse where collapses led beyond the goal,
constexpr int kRoundsForGoal = 8;  // and of redistributing after that
constexpr double kCertify = 0.99;  // of the goal, as bounds are a hundredth above what they bound
constexpr std::uint64_t kCertifySamples = 1000, kCertifyQueries = 1'000'000;
constexpr double kVolumeMax = 1.02, kVolumeMean = 1.005;  // how far errors may rise to meet the volume
constexpr double kRoundsMean = 1.03;                      // how far the mean may rise over the fitted one's
constexpr int kSolves = 6;
constexpr int kFitAttempts = 3;

// The first name that no vertex of the original has.
std::uint32_t first_new_name(const FeedbackSource& source) {
  return static_cast<std::uint32_t>(source.target.original().vertex_count());
}

// For each vertex of a mesh, the largest distance found at the triangle of a level that is closest to it; 0 where none
// is or the task is cancelled.
std::vector<double> error_at_vertices(const Mesh& mesh, const TrackedLevel& level, const Task& task) {
  std::vector<double> worst(mesh.vertex_count(), 0.0);
  const spatial::Surface surface = simplify::surface_of(level.mesh(), task);
  if (task.cancelled() || surface.triangles.empty()) return worst;
  const spatial::Bvh tree(surface, task);
  const std::vector<simplify::TriangleError> all = level.worst();
  parallel_for(worst.size(), 4096, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    std::vector<Vec3d> points;
    for (std::size_t v = begin; v < end; ++v) points.push_back(mesh.position(static_cast<std::uint32_t>(v)));
    std::vector<spatial::Nearest> closest(points.size());
    spatial::ClosestBatch(tree).find(points, closest);
    for (std::size_t v = begin; v < end; ++v) worst[v] = all[surface.drawn[closest[v - begin].triangle]].distance;
  });
  return worst;
}

// Raises the weights of the start's vertices where the level is worst.
void raise_weights(const Mesh& start, const TrackedLevel& level, std::vector<float>& weights, const Task& task) {
  const std::vector<double> worst = error_at_vertices(start, level, task);
  const double limit = kBad * level.max();
  for (std::size_t v = 0; v < worst.size(); ++v) {
    if (!(worst[v] > limit)) continue;
    const double ratio = worst[v] / limit;
    const double factor = std::min(ratio * ratio * ratio * ratio * ratio * ratio, kMostFactor);
    const double raised = std::min(static_cast<double>(weights[v]) * factor, kMostWeight);
    weights[v] = std::max(weights[v], static_cast<float>(raised));
  }
}

// The start collapsed again, vertices where the level is worst weighing more; the round with the smallest maximum.
Result<NamedLevel> weighted(const FeedbackSource& source, NamedLevel best, Effort effort, const Task& task) {
  EdgeCollapseOptions options = source.options;
  options.target_triangles = best.level.mesh().triangles.size();
  options.record_log = false;
  options.weights.resize(source.start.vertex_count(), 1.0F);
  options.no_move = of_original(source.start_names, source.options.no_move);
  TrackedLevel current = best.level;
  const double start_mean = best.level.mean();
  TrackedLevel::Faults most_faults = best.level.faults(task);
  bool knows_original = false;
  for (int round = 0; round < kWeightedRounds && !task.cancelled(); ++round) {
    raise_weights(source.start, current, options.weights, task);
    weight_borders(source.start, kBorder, options.weights, task);
    Result<simplify::EdgeCollapseResult> made = simplify::collapse_edges(source.start, options, task.part(0.3));
    LODESTONE_TRY(made);
    if (made->mesh.triangles.empty() || task.cancelled()) break;
    current = TrackedLevel(source.target, std::move(made->mesh), task);
    if (!(current.max() < best.level.max()) || current.mean() > kMeanSlack * start_mean) continue;
    // Collapses leave some of the original's faults, not always the same: as many as it has are allowed, unless the
    // level is to be fitted.
    const TrackedLevel::Faults faults = current.faults(task);
    if (!faults.no_more_than(most_faults) && effort == Effort::normal && !knows_original) {
      const spatial::Surface& original = source.target.surface();
      most_faults.intersections =
          std::max(most_faults.intersections, spatial::self_intersections(source.target.tree(), {}, task).size());
      most_faults.folds = std::max(most_faults.folds, spatial::folds(original).size());
      knows_original = true;
    }
    if (faults.no_more_than(most_faults)) best = {current, names_after(source.start_names, made->vertex_origin)};
  }
  return best;
}

bool has_borders(const Mesh& mesh, const Task& task) {
  const EdgeTriangles edges = edge_triangles(mesh, task);
  return std::any_of(edges.edges.begin(), edges.edges.end(), [](const Edge& e) { return e.count != 2; });
}

// Adds marked vertices to a list of no_move or no_collapse, and sorts it by name.
void hold(const NamedLevel& level, const std::vector<std::uint8_t>& marked, std::vector<HeldVertex>& list) {
  const Mesh& mesh = level.level.mesh();
  for (std::size_t v = 0; v < marked.size(); ++v) {
    if (marked[v] != 0) list.push_back({level.names[v], mesh.positions[v]});
  }
  const auto key = [](const HeldVertex& h) { return std::tuple{h.name, h.position.x, h.position.y, h.position.z}; };
  std::sort(list.begin(), list.end(), [&](const HeldVertex& a, const HeldVertex& b) { return key(a) < key(b); });
  const auto end =
      std::unique(list.begin(), list.end(), [&](const HeldVertex& a, const HeldVertex& b) { return key(a) == key(b); });
  list.erase(end, list.end());
}

// Adds the vertices of a level where a coarser one is farther from the original than a limit.
void hold_beyond(const NamedLevel& level, const TrackedLevel& coarser, double limit, std::vector<HeldVertex>& list,
                 const Task& task) {
  const std::vector<double> worst = error_at_vertices(level.level.mesh(), coarser, task);
  std::vector<std::uint8_t> bad(worst.size());
  for (std::size_t v = 0; v < worst.size(); ++v) bad[v] = worst[v] > limit ? 1 : 0;
  hold(level, bad, list);
}

// Rounds of redistributing; the one with the smallest maximum. The mean is at most `most_mean`; no faults are added.
Result<NamedLevel> redistribute_rounds(const FeedbackSource& source, NamedLevel best, double most_mean,
                                       const TrackedLevel::Faults& most_faults, const Task& task) {
  const std::size_t triangles = best.level.mesh().triangles.size();
  RedistributeOptions options;
  options.most_triangles = triangles;
  std::uint32_t next_name = first_new_name(source);
  NamedLevel current = best;
  for (int round = 0, idle = 0; round < kRounds && idle < kIdleRounds && !task.cancelled(); ++round) {
    const Task part =
        task.part(1.0 / kRounds, fmt::format("round {}, maximum {}", round + 1, short_number(best.level.max())));
    Result<NamedLevel> next = redistribute_triangles(source, current, options, next_name, part);
    LODESTONE_TRY(next);
    const TrackedLevel& made = next->level;
    if (made.mesh().triangles.empty() || made.mean() > most_mean || made.mesh().triangles.size() > triangles) break;
    ++idle;
    const TrackedLevel::Faults faults = made.faults(task);
    if (!faults.no_more_than(most_faults)) {
      hold(*next, faults.vertices, options.no_move);  // and again from the level before
      continue;
    }
    current = std::move(*next);
    if (!(current.level.max() < best.level.max())) continue;
    best = current;
    idle = 0;
  }
  return best;
}

// Whether a level is certified to be within the goal. If not, it is told the worst place (probe_error()).
Result<bool> holds_goal(const FeedbackSource& source, TrackedLevel& level, const Task& task) {
  measure::DistanceOptions options;
  options.samples = kCertifySamples;
  options.queries = kCertifyQueries;
  options.input = Input::valid;
  const Result<measure::Distance> d = source.reference->distance_to(make_model(Mesh(level.mesh())), options, task);
  LODESTONE_TRY(d);
  const double most = kCertify * source.goal;
  if (d->bound <= most) return true;
  if (d->forward.bound > most) level.probe_error(d->forward.max_at, true, task);
  if (d->backward.bound > most) level.probe_error(d->backward.max_at, false, task);
  return false;
}

// A level of at most options.most_triangles that is certified to be within the goal; nothing where none was found.
// Vertices where collapses led beyond the goal become no_collapse, and the start is collapsed again; if that is not
// enough, what came out is redistributed.
Result<std::optional<NamedLevel>> within_goal(const FeedbackSource& source, const NamedLevel& start,
                                              const TrackedLevel::Faults& most_faults, RedistributeOptions& options,
                                              const Task& task) {
  const double most = kCertify * source.goal;
  std::uint32_t next_name = first_new_name(source);
  for (const std::uint32_t name : start.names) next_name = std::max(next_name, name + 1);
  bool found = false;
  Result<NamedLevel> made = redistribute_triangles(source, start, options, next_name, task);
  const auto look = [&]() -> Result<void> {
    LODESTONE_TRY(made);
    TrackedLevel& level = made->level;
    found = !level.mesh().triangles.empty() && level.mesh().triangles.size() <= options.most_triangles;
    found = found && level.max() <= most && level.faults(task).no_more_than(most_faults);
    if (!found) return {};
    const Result<bool> holds = holds_goal(source, level, task);
    LODESTONE_TRY(holds);
    found = *holds;
    return {};
  };
  Result<void> looked = look();
  for (int retry = 0; looked && !found && retry < kRetries && !task.cancelled(); ++retry) {
    const std::size_t known = options.no_collapse.size();
    hold_beyond(start, made->level, most, options.no_collapse, task);
    if (options.no_collapse.size() == known) break;
    made = redistribute_triangles(source, start, options, next_name, task);
    looked = look();
  }
  for (int round = 0; looked && !found && options.fits && round < kRoundsForGoal && !task.cancelled(); ++round) {
    made = redistribute_triangles(source, *made, options, next_name, task);
    looked = look();
  }
  LODESTONE_TRY(looked);
  if (!found) return std::nullopt;
  return std::make_optional(std::move(*made));
}

// Fewer and fewer triangles within the goal; nothing where not even the start's own number can be brought there.
Result<std::optional<NamedLevel>> fewest_within_goal(const FeedbackSource& source, const NamedLevel& start, bool fits,
                                                     const Task& task) {
  const TrackedLevel::Faults most_faults = start.level.faults(task);
  RedistributeOptions options;
  options.fits = fits;
  options.keeps_borders = false;
  std::optional<NamedLevel> best;
  double shrink = 1;  // as it is at first
  while (shrink < kLeastShrink || !best) {
    if (task.cancelled()) break;
    const NamedLevel& level = best ? *best : start;
    const std::size_t now = level.level.mesh().triangles.size();
    const Task part = task.part(0.05, fmt::format("{} triangles", with_separators(now)));
    options.most_triangles = static_cast<std::size_t>(shrink * static_cast<double>(now));
    if (options.most_triangles == 0) break;
    Result<std::optional<NamedLevel>> next = within_goal(source, level, most_faults, options, part);
    LODESTONE_TRY(next);
    if (*next) {
      if (!best) shrink = kShrink;
      best = std::move(*next);
    } else {
      if (!best) break;
      shrink = (1 + shrink) / 2;
    }
  }
  return best;
}

// Restores the volume of the original, if errors hardly rise.
void meet_volume(TrackedLevel& level, const std::vector<std::uint8_t>& no_move, const TrackedLevel::Faults& most,
                 const Task& task) {
  TrackedLevel met = level;
  simplify::FitOptions fit;
  fit.solves = 0;
  fit.volume = true;
  fit.no_move = no_move;
  met.fit(fit, task);
  const bool is_near = met.max() <= kVolumeMax * level.max() && met.mean() <= kVolumeMean * level.mean();
  if (is_near && met.faults(task).no_more_than(most)) level = std::move(met);
}

// Fits without adding faults: where some come up, the vertices there become no_move, and all is fitted again.
void fit_without_faults(TrackedLevel& level, simplify::FitOptions options, const TrackedLevel::Faults& most,
                        const Task& task) {
  for (int attempt = 0; attempt < kFitAttempts && !task.cancelled(); ++attempt) {
    TrackedLevel next = level;
    next.fit(options, task);
    const TrackedLevel::Faults faults = next.faults(task);
    if (faults.no_more_than(most)) {
      level = std::move(next);
      return;
    }
    options.no_move.resize(level.mesh().vertex_count(), 0);
    for (std::size_t v = 0; v < options.no_move.size(); ++v) {
      if (faults.vertices[v] != 0) options.no_move[v] = 1;
    }
  }
}

Result<NamedLevel> fitted(const FeedbackSource& source, NamedLevel level, const Task& task) {
  const double plain_mean = level.level.mean();
  const TrackedLevel::Faults plain_faults = level.level.faults(task);
  // Fitting moves no borders and no non-manifold vertices; where these are worst, only other collapses help.
  if (has_borders(level.level.mesh(), task)) {
    Result<NamedLevel> start = weighted(source, std::move(level), Effort::best, task);
    if (!start) return start;
    level = std::move(*start);
  }
  const std::vector<std::uint8_t>& locked = source.options.no_move;
  simplify::FitOptions fit;
  fit.solves = kSolves;
  if (!locked.empty()) fit.no_move = of_original(level.names, locked);
  fit_without_faults(level.level, fit, plain_faults, task);
  task.advance(0.4);
  if (task.cancelled() || source.goal > 0) return level;
  // With weights, triangles are not shifted away from where they are wanted.
  if (source.options.weights.empty()) {
    const double most_mean = std::min(kRoundsMean * level.level.mean(), plain_mean);
    Result<NamedLevel> redistributed =
        redistribute_rounds(source, std::move(level), most_mean, plain_faults, task.part(0.6));
    if (!redistributed) return redistributed;
    level = std::move(*redistributed);
  }
  if (!locked.empty()) fit.no_move = of_original(level.names, locked);
  meet_volume(level.level, fit.no_move, plain_faults, task);
  return level;
}

}  // namespace

Result<Mesh> apply_feedback(const FeedbackSource& source, NamedMesh plain, Effort effort, const Task& task) {
  if (effort == Effort::fast || plain.mesh.triangles.empty()) return std::move(plain.mesh);
  const bool fits = effort == Effort::best, has_goal = source.goal > 0;
  // With weights, triangles are not shifted away from where they are wanted.
  if (has_goal && !source.options.weights.empty()) return std::move(plain.mesh);
  const NamedLevel level{TrackedLevel(source.target, std::move(plain.mesh), task), std::move(plain.names)};
  Result<NamedLevel> improved = fits ? fitted(source, level, task) : weighted(source, level, effort, task);
  if (task.cancelled()) return cancelled_error("shaping");
  LODESTONE_TRY(improved);
  if (!has_goal) return improved->level.mesh();
  // If the improved level does not reach the goal, the plain one may: fitted on the way, or at last without fitting.
  struct Way {
    const NamedLevel* start;
    bool fits;
  };
  std::vector<Way> ways{{&*improved, fits}, {&level, false}};
  if (fits) ways.insert(ways.begin() + 1, {&level, true});
  for (const Way& way : ways) {
    Result<std::optional<NamedLevel>> fewest = fewest_within_goal(source, *way.start, way.fits, task);
    if (task.cancelled()) return cancelled_error("shaping");
    LODESTONE_TRY(fewest);
    if (*fewest) return (*fewest)->level.mesh();
  }
  return level.level.mesh();
}

}  // namespace lodestone::chain::detail
