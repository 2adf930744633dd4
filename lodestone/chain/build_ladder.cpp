// Method   one collapse run a mesh -> merged order -> a prefix a level -> measured against the original in world space
// Targets  counts by the record alone; errors by bisection over prefixes, each probe replayed and measured
#include "lodestone/chain/build_ladder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lodestone/base/stopwatch.h"
#include "lodestone/base/units.h"
#include "lodestone/chain/collapse_plan_detail.h"
#include "lodestone/chain/ladder_detail.h"
#include "lodestone/chain/level_error_detail.h"

namespace lodestone::chain {

using detail::CollapsePlan;
using measure::Reference;

namespace {

tl::unexpected<Error> bad(std::string what, std::string remedy) {
  return fail(ErrorCode::bad_argument, std::move(what), {}, std::move(remedy));
}

Result<void> check(const LadderOptions& options) {
  const int families =
      (options.ratios.empty() ? 0 : 1) + (options.triangles.empty() ? 0 : 1) + (options.errors.empty() ? 0 : 1);
  if (families > 1) return bad("ratios, triangle counts and errors are asked for at once", "give one of them");
  if (families == 0 && options.levels < 2) {
    return bad(fmt::format("{} levels leave nothing to make", options.levels), "ask for 2 or more, with level 0");
  }
  for (std::size_t i = 0; i < options.ratios.size(); ++i) {
    const double r = options.ratios[i];
    if (!(r > 0 && r < 1)) return bad(fmt::format("ratio {} is not between 0 and 1", r), "0.1 or 10% keeps a tenth");
    if (i > 0 && !(r < options.ratios[i - 1])) return bad("the ratios do not fall", "name the finest level first");
  }
  for (std::size_t i = 0; i < options.triangles.size(); ++i) {
    if (options.triangles[i] == 0) return bad("a level of 0 triangles is asked for", "ask for at least 1");
    if (i > 0 && options.triangles[i] >= options.triangles[i - 1]) {
      return bad("the triangle counts do not fall", "name the finest level first");
    }
  }
  for (std::size_t i = 0; i < options.errors.size(); ++i) {
    if (!(options.errors[i] > 0) || !std::isfinite(options.errors[i])) {
      return bad(fmt::format("error {} is not above 0", options.errors[i]), "give a length above 0");
    }
    if (i > 0 && !(options.errors[i] > options.errors[i - 1])) {
      return bad("the errors do not rise", "name the finest level first");
    }
  }
  return {};
}

// Where a few spots make the whole mean, it depends on how many samples hit them: four times as many are taken then.
// The limit is a relative standard error of 1 % (that of independent samples; stratified ones do better).
Result<measure::Distance> measure_steadily(const measure::Reference& reference, const Model& model,
                                           const measure::DistanceOptions& options, const Task& task) {
  Result<measure::Distance> d = reference.distance_to(model, options, task.part(0.5));
  constexpr double kSteady = 0.01, kNothing = 1e-7;
  if (!d || d->mean <= kNothing * d->diagonal) return d;
  const double spread = d->rms / d->mean;
  if (spread * spread - 1 <= kSteady * kSteady * static_cast<double>(d->samples)) return d;
  measure::DistanceOptions more = options;
  more.samples *= 4;
  return reference.distance_to(model, more, task.part(0.5));
}

// A prefix of the plan, made and measured.
struct Cut {
  std::size_t prefix = 0;
  Level level;
  double simplify_seconds = 0, measure_seconds = 0;
};

const char* method_of(Effort effort) {
  if (effort == Effort::fast) return "edge collapse";
  return effort == Effort::normal ? "edge collapse, weighted by its error" : "edge collapse, fitted by its error";
}

// Makes and measures levels of one plan.
class LevelMaker {
 public:
  LevelMaker(const CollapsePlan& plan, const Reference& reference, const measure::DistanceOptions& distance,
             Effort effort)
      : plan_(plan),
        reference_(reference),
        distance_(distance),
        effort_(plan.can_be_shaped() ? effort : Effort::fast) {}

  const CollapsePlan& plan() const { return plan_; }
  Effort effort() const { return effort_; }

  /// The level that edge collapse alone makes.
  Result<Cut> plain(std::size_t prefix, const Task& task) const {
    Cut cut;
    const Stopwatch making;
    Result<Model> model = plan_.model_after(prefix, task.part(0.3));
    if (!model) return fail(model.error());
    cut.simplify_seconds = making.total();
    return measured(std::move(cut), prefix, std::move(*model), Effort::fast, task.part(0.7));
  }

  /// The same shaped by its error, if that is better; else the plain one. With a goal fewer triangles within it are
  /// better.
  Result<Cut> shaped(std::size_t prefix, const Task& task, double goal = 0) {
    Result<Cut> cut = plain(prefix, task.part(effort_ == Effort::fast ? 1.0 : 0.2));
    if (!cut || effort_ == Effort::fast || prefix == 0) return cut;
    Cut shaping;
    const Stopwatch making;
    Result<Model> model = plan_.shaped_after(prefix, effort_, goal, targets_, task.part(0.6, "shaping"));
    if (!model) return fail(model.error());
    shaping.simplify_seconds = cut->simplify_seconds + making.total();
    shaping.measure_seconds = cut->measure_seconds;
    Result<Cut> made = measured(std::move(shaping), prefix, std::move(*model), effort_, task.part(0.2));
    if (!made) return made;
    if (is_better(*made, *cut, goal)) return made;
    cut->simplify_seconds = made->simplify_seconds;
    cut->measure_seconds = made->measure_seconds;
    cut->level.seconds = cut->simplify_seconds + cut->measure_seconds;
    return cut;
  }

 private:
  static constexpr double kMeanSlack = 1.01;

  bool is_better(const Cut& made, const Cut& plain, double goal) const {
    const LevelError &now = made.level.error, &then = plain.level.error;
    if (made.level.triangles > plain.level.triangles) return false;
    if (goal > 0 && made.level.triangles < plain.level.triangles) return now.measured_error <= goal;
    const double slack = effort_ == Effort::normal ? kMeanSlack : 1;
    const bool no_worse = now.measured_error <= then.measured_error && now.mean_error <= slack * then.mean_error;
    return no_worse && (now.measured_error < then.measured_error || now.mean_error < then.mean_error);
  }

  Result<Cut> measured(Cut cut, std::size_t prefix, Model model, Effort effort, const Task& task) const {
    const Stopwatch measuring;
    const Result<measure::Distance> d = measure_steadily(reference_, model, distance_, task);
    if (!d) return fail(d.error());
    cut.prefix = prefix;
    cut.measure_seconds += measuring.total();
    cut.level.triangles = drawn_triangles(model);
    cut.level.vanished_parts = plan_.vanished_after(prefix);
    cut.level.model = std::move(model);
    cut.level.method = method_of(effort);
    cut.level.seconds = cut.simplify_seconds + cut.measure_seconds;
    cut.level.error = detail::level_error(*d);
    return cut;
  }

  const CollapsePlan& plan_;
  const Reference& reference_;
  const measure::DistanceOptions& distance_;
  Effort effort_;
  detail::FitTargets targets_;
};

// The coarsest cut found whose measured maximum is within a limit, by bisection on the logarithm of the triangle count
// between `good`, a prefix that is within it or is taken for it, and `bad`, one that is not, until the bracket is
// within `nearness`. Nothing within the limit: nothing.
struct Search {
  std::size_t good, bad;
  double nearness;
  std::optional<Cut> best;
  double simplify_seconds = 0, measure_seconds = 0;

  // The cut becomes the best, whatever its error.
  Result<void> take(Result<Cut> cut) {
    if (!cut) return fail(cut.error());
    simplify_seconds += cut->simplify_seconds;
    measure_seconds += cut->measure_seconds;
    best = std::move(*cut);
    return {};
  }

  template <class Make>
  Result<void> probe(double limit, std::size_t prefix, Make&& make) {
    Result<Cut> cut = make(prefix);
    if (!cut) return fail(cut.error());
    if (cut->level.error.measured_error <= limit) {
      good = prefix;
      return take(std::move(cut));
    }
    simplify_seconds += cut->simplify_seconds;
    measure_seconds += cut->measure_seconds;
    bad = prefix;
    return {};
  }

  // The prefix to look at next; 0 when the bracket is narrow enough.
  std::size_t next(const CollapsePlan& plan) const {
    const auto fine = static_cast<double>(plan.triangles_after(good));
    const auto coarse = static_cast<double>(plan.triangles_after(std::min(plan.size(), bad)));
    if (bad <= good + 1 || fine - coarse <= nearness * coarse) return 0;
    return std::clamp(plan.prefix_for(static_cast<std::size_t>(std::sqrt(fine * coarse))), good + 1, bad - 1);
  }

  template <class Make>
  Result<void> run(const CollapsePlan& plan, double limit, std::size_t first, Make&& make) {
    for (std::size_t prefix = first;;) {
      if (const Result<void> ok = probe(limit, prefix, make); !ok) return ok;
      prefix = next(plan);
      if (prefix == 0) return {};
    }
  }
};

// Where searches for errors have come to: the next, larger error needs nothing finer.
struct Starts {
  std::size_t plain = 0;   // the coarsest plain prefix within the last error
  std::size_t shaped = 0;  // the prefix of the last level
};

// Shapes a level to as few triangles as `limit` allows, fewer than the last level has (`last`, its prefix). Fitting
// brings one that is somewhat coarser than the plain one within the limit, and collapses that were not limited one by
// one make better triangles: that start first.
Result<void> shape_fewest(LevelMaker& maker, Search& search, std::size_t last, double limit, const Task& task) {
  constexpr double kCoarserStart = 0.8;
  const CollapsePlan& plan = maker.plan();
  const std::size_t plain = search.good;
  const auto fewer = static_cast<std::size_t>(kCoarserStart * static_cast<double>(plan.triangles_after(plain)));
  std::vector<std::size_t> starts{std::max(plain, plan.prefix_for(fewer)), plain, std::max(plain, last)};
  starts.erase(std::unique(starts.begin(), starts.end()), starts.end());
  for (const std::size_t start : starts) {
    Result<Cut> cut = maker.shaped(start, task.part(0.3), limit);
    if (!cut) return fail(cut.error());
    // One that has fewer triangles than the plan's end is not the end.
    const std::size_t reached = std::min(plan.prefix_for(cut->level.triangles), plan.size() - 1);
    if (cut->level.error.measured_error <= limit && std::max(start, reached) > last) {
      cut->prefix = std::max(start, reached);
      search.good = cut->prefix;
      return search.take(std::move(cut));
    }
    search.simplify_seconds += cut->simplify_seconds;
    search.measure_seconds += cut->measure_seconds;
  }
  return {};
}

// The coarsest prefix found whose measured maximum is within `limit`, not finer than the last level: plain levels
// first, within one per cent; then one shaped from there on. Nothing within the limit: the plain cut where the last
// level was.
Result<Cut> find_error_cut(LevelMaker& maker, Starts& starts, double limit, const Task& task) {
  constexpr double kNear = 0.01;
  const CollapsePlan& plan = maker.plan();
  const bool shapes = maker.effort() != Effort::fast;
  const Task probes = task.part(shapes ? 0.3 : 0.9, "searching");
  Search search{starts.plain, plan.size() + 1, kNear, {}};
  const Result<void> found =
      search.run(plan, limit, plan.size(), [&](std::size_t probe) { return maker.plain(probe, probes.part(0.1)); });
  if (!found) return fail(found.error());
  starts.plain = search.good;
  if (shapes && search.good < plan.size()) {
    const Task shaping = task.part(0.7, "shaping");
    if (const Result<void> ok = shape_fewest(maker, search, starts.shaped, limit, shaping); !ok)
      return fail(ok.error());
  }
  if (search.good < starts.shaped) search.good = starts.shaped;  // shaped, the last level holds what plain ones don't
  if (!search.best || search.best->prefix != search.good) {
    if (const Result<void> ok = search.take(maker.plain(search.good, task)); !ok) return fail(ok.error());
  }
  Cut best = std::move(*search.best);
  best.simplify_seconds = search.simplify_seconds;
  best.measure_seconds = search.measure_seconds;
  best.level.seconds = best.simplify_seconds + best.measure_seconds;
  return best;
}

std::string count_shortfall(const CollapsePlan& plan, std::size_t wanted, std::size_t got) {
  return fmt::format("{} triangles were asked for, {} are the fewest: {}", with_separators(wanted),
                     with_separators(got), plan.why_it_ends());
}

// Adds a cut with its error raised to the finer levels' and accounts its time.
void add_level(LadderResult& result, Cut cut) {
  LevelError& e = cut.level.error;
  e.error = std::max(e.measured_error, result.ladder.levels.back().error.error);
  result.simplify_seconds += cut.simplify_seconds;
  result.measure_seconds += cut.measure_seconds;
  result.ladder.levels.push_back(std::move(cut.level));
}

Result<void> add_count_levels(LadderResult& result, LevelMaker& maker, const std::vector<std::size_t>& targets,
                              const LadderOptions& options, const Task& task) {
  const CollapsePlan& plan = maker.plan();
  std::size_t last = 0;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const Task part = task.part(1.0 / static_cast<double>(targets.size()), fmt::format("level {}", i + 1));
    const std::size_t prefix = plan.prefix_for(targets[i]), left = plan.triangles_after(prefix);
    const bool short_of = left > targets[i];
    // A level that hardly differs from the one before is no level: the ladder ends.
    const bool shrinks = left * 100 <= result.ladder.levels.back().triangles * 97;
    if (short_of) result.shortfalls.push_back({i + 1, count_shortfall(plan, targets[i], left)});
    const bool differs = prefix > last || (options.start && i == 0);  // what it starts from is a level already
    if (differs && (!short_of || shrinks)) {
      Result<Cut> cut = maker.shaped(prefix, part);
      if (!cut) return fail(cut.error());
      add_level(result, std::move(*cut));
      last = prefix;
    } else if (!short_of) {
      result.shortfalls.push_back({i + 1, "it would not differ from the level before"});
    }
    if (short_of) break;
  }
  return {};
}

Result<void> add_error_levels(LadderResult& result, LevelMaker& maker, const LadderOptions& options, const Task& task) {
  const CollapsePlan& plan = maker.plan();
  std::size_t last = 0;
  Starts starts;
  for (std::size_t i = 0; i < options.errors.size(); ++i) {
    const Task part = task.part(1.0 / static_cast<double>(options.errors.size()), fmt::format("level {}", i + 1));
    Result<Cut> cut = find_error_cut(maker, starts, options.errors[i], part);
    if (!cut) return fail(cut.error());
    const bool holds = cut->level.error.measured_error <= options.errors[i];
    if (cut->prefix == last && !(options.start && i == 0 && holds)) {
      result.shortfalls.push_back(
          {i + 1,
           fmt::format("nothing coarser than the level before has a measured error within {:.6g}", options.errors[i])});
      result.simplify_seconds += cut->simplify_seconds;
      result.measure_seconds += cut->measure_seconds;
      continue;
    }
    last = starts.shaped = cut->prefix;
    add_level(result, std::move(*cut));
    if (last == plan.size() && i + 1 < options.errors.size()) {
      result.shortfalls.push_back({i + 2, "the level before is the coarsest there is: " + plan.why_it_ends()});
      break;
    }
  }
  return {};
}

Result<void> check_drawn(const Model& original) {
  if (drawn_triangles(original) > 0) return {};
  return fail(ErrorCode::empty, "the model draws no triangle", {}, "is a scene with meshes in the file?");
}

}  // namespace

std::vector<std::size_t> detail::count_targets(const LadderOptions& options, std::size_t drawn) {
  if (!options.triangles.empty()) return options.triangles;
  std::vector<std::size_t> targets;
  const auto share_of = [&](double share) {
    return std::max<std::size_t>(1, static_cast<std::size_t>(static_cast<double>(drawn) * share + 0.5));
  };
  for (const double ratio : options.ratios) targets.push_back(share_of(ratio));
  if (!targets.empty()) return targets;
  double share = 1;
  for (std::size_t level = 1; level < options.levels; ++level) targets.push_back(share_of(share *= 0.5));
  return targets;
}

Result<void> detail::check_ladder(const Model& original, const LadderOptions& options) {
  if (const Result<void> ok = check(options); !ok) return ok;
  return check_drawn(original);
}

Level detail::original_level(const Model& original, double diagonal) {
  Level level;
  level.triangles = drawn_triangles(original);
  level.method = "original";
  level.error.diagonal = diagonal;
  level.error.kind = ErrorKind::bounded;  // it is the original itself
  return level;
}

Result<void> detail::compare_pictures(LadderResult& result, const measure::ImageOptions& options, const Task& task) {
  const Stopwatch watch;
  const auto reference = measure::ImageReference::create(result.ladder.original, options, task.part(0.2));
  if (!reference) return fail(reference.error());
  const std::size_t levels = result.ladder.levels.size();
  for (std::size_t i = 0; i < levels; ++i) {
    const Task part = task.part(0.8 / static_cast<double>(levels));
    const auto deviation = reference->deviation_of(result.ladder.model(i), part);
    if (!deviation) return fail(deviation.error());
    result.images.push_back(*deviation);
  }
  result.measure_seconds += watch.total();
  return {};
}

Result<LadderResult> build_ladder(Model original, const LadderOptions& options, Task task) {
  if (const Result<void> ok = detail::check_ladder(original, options); !ok) return fail(ok.error());
  const std::vector<std::size_t> targets = detail::count_targets(options, drawn_triangles(original));
  const std::size_t smallest = options.errors.empty() ? targets.back() : 1;

  LadderResult result;
  result.ladder.original = std::move(original);
  const Model& model = result.ladder.original;
  const Stopwatch collapsing;
  const Result<CollapsePlan> plan = CollapsePlan::create(options.start ? *options.start : model, smallest,
                                                         options.influence, task.part(0.4, "collapsing"));
  if (!plan) return fail(plan.error());
  result.simplify_seconds = collapsing.total();
  const Stopwatch preparing;
  const Result<Reference> reference = Reference::create(model, task.part(0.05, "preparing to measure"));
  if (!reference) return fail(reference.error());
  result.measure_seconds = preparing.total();
  result.ladder.levels.push_back(detail::original_level(model, reference->diagonal()));
  const Task measuring = task.part(options.image ? 0.4 : 0.55, "measuring");
  LevelMaker maker(*plan, *reference, options.distance, options.effort);
  const Result<void> added = options.errors.empty() ? add_count_levels(result, maker, targets, options, measuring)
                                                    : add_error_levels(result, maker, options, measuring);
  if (!added) return fail(added.error());
  if (options.image) {
    const Result<void> compared =
        detail::compare_pictures(result, *options.image, task.part(0.15, "comparing pictures"));
    if (!compared) return fail(compared.error());
  }
  return result;
}

Result<SimplifyModelResult> simplify_model(const Model& original, const SimplifyModelOptions& options, Task task) {
  const bool by_count = options.target_triangles > 0, by_error = options.max_error > 0;
  if (by_count == by_error) {
    return bad(by_count ? "a triangle count and an error are asked for at once" : "no target is asked for",
               "give a triangle count, a ratio or an error");
  }
  if (const Result<void> ok = check_drawn(original); !ok) return fail(ok.error());
  const Stopwatch collapsing;
  const Result<CollapsePlan> plan = CollapsePlan::create(original, by_count ? options.target_triangles : 1,
                                                         options.influence, task.part(0.5, "collapsing"));
  if (!plan) return fail(plan.error());
  SimplifyModelResult result;
  result.simplify_seconds = collapsing.total();
  const Stopwatch preparing;
  const Result<Reference> reference = Reference::create(original, task.part(0.1, "preparing to measure"));
  if (!reference) return fail(reference.error());
  result.measure_seconds = preparing.total();
  const Task rest = task.part(0.4, "measuring");
  LevelMaker maker(*plan, *reference, options.distance, options.effort);
  Starts starts;
  Result<Cut> cut = by_count ? maker.shaped(plan->prefix_for(options.target_triangles), rest)
                             : find_error_cut(maker, starts, options.max_error, rest);
  if (!cut) return fail(cut.error());
  result.simplify_seconds += cut->simplify_seconds;
  result.measure_seconds += cut->measure_seconds;
  result.locked = plan->locked();
  result.level = std::move(cut->level);
  const bool at_end = cut->prefix == plan->size();
  if (by_count && result.level.triangles > options.target_triangles) {
    result.stop = simplify::StopReason::no_legal_collapse;
    result.shortfall = count_shortfall(*plan, options.target_triangles, result.level.triangles);
  } else if (by_count) {
    result.stop = simplify::StopReason::reached_target;
  } else {
    result.stop = at_end ? simplify::StopReason::no_legal_collapse : simplify::StopReason::error_limit;
    if (cut->prefix == 0) {
      result.shortfall = fmt::format("no coarser mesh has a measured error within {:.6g}", options.max_error);
    }
  }
  return result;
}

std::vector<std::vector<double>> screen_coverages(const Ladder& ladder, const measure::View& view) {
  std::vector<std::vector<double>> rows;
  for (const Instance& instance : ladder.original.instances) {
    Box3d box;
    const Mesh& mesh = ladder.original.meshes[instance.mesh];
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      for (const std::uint32_t v : mesh.vertices_of(t)) box.add(instance.transform.point(mesh.position(v)));
    }
    const double radius = box.diagonal() / 2;
    std::vector<double> row;
    for (std::size_t level = 1; level < ladder.levels.size(); ++level) {
      row.push_back(
          measure::screen_coverage(radius, measure::switch_distance(ladder.levels[level].error.error, 1, view), view));
    }
    row.push_back(0);  // the coarsest never vanishes
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace lodestone::chain
