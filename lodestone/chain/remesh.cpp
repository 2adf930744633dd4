#include "lodestone/chain/remesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lodestone/base/stopwatch.h"
#include "lodestone/base/units.h"
#include "lodestone/chain/ladder_detail.h"
#include "lodestone/chain/level_error_detail.h"
#include "lodestone/chain/voxel_search_detail.h"

namespace lodestone::chain {

using detail::VoxelCut;

namespace {

constexpr std::uint32_t kUsual = 128;
constexpr std::uint32_t kMostForError = 1024;  // finer surfaces than that are asked for by name

Result<void> check(const RemeshOptions& options) {
  const auto bad = [](std::string what, std::string remedy) {
    return fail(ErrorCode::bad_argument, std::move(what), {}, std::move(remedy));
  };
  const bool count = options.triangles > 0, error = options.error > 0;
  if (count && error) return bad("a triangle count and an error are asked for at once", "choose one");
  if (options.then_collapse && !count && !error) {
    return bad("--then-collapse needs a target", "add --triangles or --error");
  }
  if (options.resolution > 0 && (count || error) && !options.then_collapse) {
    return bad("--resolution and a target are asked for at once", "choose one, or add --then-collapse");
  }
  return {};
}

// How fine the surface must be that is collapsed: so that the target's error is not that of the voxels.
constexpr std::size_t kStartTriangles = 16, kLeastStart = 200'000, kMostStart = 4'000'000;
constexpr double kStartError = 3;

// The finest resolution that levels will be asked for.
Result<std::uint32_t> finest_for(const Model& model, const RemeshOptions& options, const Task& task) {
  if (options.resolution > 0) return options.resolution;
  if (options.triangles > 0) {
    const std::size_t start = std::clamp(options.triangles * kStartTriangles, kLeastStart, kMostStart);
    const std::size_t wanted = options.then_collapse ? std::max(start, options.triangles) : options.triangles;
    const Result<std::uint32_t> predicted = detail::predict_resolution(model, options.voxel, wanted, task);
    if (!predicted) return predicted;
    return std::max<std::uint32_t>(8, *predicted + (options.then_collapse ? 0 : *predicted / 8));
  }
  return options.error > 0 ? kMostForError / 2 : kUsual;
}

Result<VoxelCut> make_cut(VoxelLevels& levels, std::uint32_t resolution, const Task& task) {
  Result<Mesh> mesh = levels.surface_at(resolution, task);
  if (!mesh) return fail(mesh.error());
  return VoxelCut{resolution, std::move(*mesh), {}};
}

Result<VoxelCut> cut_for(VoxelLevels& levels, const RemeshOptions& options, std::uint32_t finest,
                         const measure::Reference* reference, const Task& task) {
  if (options.then_collapse && options.error > 0 && options.resolution == 0) {
    return detail::find_error(levels, options.error / kStartError, kUsual, *reference, options.distance, task);
  }
  if (options.then_collapse || options.resolution > 0) return make_cut(levels, finest, task);
  if (options.triangles > 0) return detail::find_count(levels, options.triangles, finest * 8 / 9, task);
  if (options.error > 0) return detail::find_error(levels, options.error, 64, *reference, options.distance, task);
  return make_cut(levels, finest, task);
}

Model model_of(Mesh mesh, const Model& source) {
  Model out = make_model(std::move(mesh));
  out.meters_per_unit = source.meters_per_unit;
  out.gltf_axes = source.gltf_axes;
  return out;
}

Result<void> collapse(const Model& model, const RemeshOptions& options, Mesh mesh, RemeshResult& out,
                      const Task& task) {
  LadderOptions ladder;
  ladder.start = model_of(std::move(mesh), model);
  ladder.distance = options.distance;
  const std::size_t start = ladder.start->meshes.front().triangles.size();
  if (options.triangles > 0) ladder.triangles = {std::min(options.triangles, start)};
  if (options.error > 0) ladder.errors = {options.error};
  Model original = model;
  Result<LadderResult> made = build_ladder(std::move(original), ladder, task);
  if (!made) return fail(made.error());
  if (!made->shortfalls.empty()) out.shortfall = made->shortfalls.front().reason;
  if (made->ladder.levels.size() < 2) {
    return fail(ErrorCode::bad_argument, "the surface by voxels is not within the error that is asked for", {},
                "raise --resolution");
  }
  out.level = std::move(made->ladder.levels[1]);
  out.level.method = "voxels and edge collapse";
  out.seconds.collapse += made->simplify_seconds;
  out.seconds.measure += made->measure_seconds;
  return {};
}

void tell_vanished(const VoxelLevels& levels, const Model& model, const Mesh& mesh, std::uint32_t resolution,
                   std::vector<std::string>& warnings) {
  const std::vector<std::string> gone = levels.vanished(model, mesh, resolution);
  if (gone.empty()) return;
  constexpr std::size_t kNamed = 4;
  const auto end = gone.begin() + static_cast<std::ptrdiff_t>(std::min(kNamed, gone.size()));
  warnings.push_back(fmt::format("{} of the model's pieces vanished, as they are thinner than a voxel: {}{}",
                                 with_separators(gone.size()), fmt::join(gone.begin(), end, "; "),
                                 gone.size() > kNamed ? "; ..." : ""));
}

std::string shortfall_of(const RemeshOptions& options, const VoxelCut& cut) {
  const std::size_t count = cut.mesh.triangles.size();
  if (options.triangles > 0 && (count > options.triangles || count * 10 < options.triangles * 9)) {
    return fmt::format("{} triangles were asked for, {} are the nearest that a resolution gives",
                       with_separators(options.triangles), with_separators(count));
  }
  if (options.error > 0 && cut.distance && cut.distance->trusted_max() > options.error) {
    return fmt::format("no resolution up to {} has a measured error within {:.6g}", cut.resolution, options.error);
  }
  return {};
}

}  // namespace

Result<RemeshResult> remesh(const Model& model, const RemeshOptions& options, Task task) {
  if (const Result<void> ok = check(options); !ok) return fail(ok.error());
  RemeshResult out;
  Stopwatch watch;
  const Result<std::uint32_t> finest = finest_for(model, options, task.part(0.1));
  if (!finest) return fail(finest.error());
  Result<VoxelLevels> levels = VoxelLevels::create(model, options.voxel, *finest, task.part(0.3));
  if (!levels) return fail(levels.error());
  std::optional<measure::Reference> reference;
  const bool measures = options.error > 0 || (options.measure && !levels->by_slabs());
  if (options.measure && !measures) {
    out.warnings.emplace_back("the error is not measured on a surface as large as this: 'lod measure' does it");
  }
  if (measures) {
    const Stopwatch preparing;
    Result<measure::Reference> made = measure::Reference::create(model, task.part(0.1));
    if (!made) return fail(made.error());
    reference.emplace(std::move(*made));
    out.seconds.measure += preparing.total();
  }
  Result<VoxelCut> cut = cut_for(*levels, options, *finest, reference ? &*reference : nullptr, task.part(0.2));
  if (!cut) return fail(cut.error());
  const VoxelSeconds& made = levels->seconds();
  out.seconds.prepare = made.prepare;
  out.seconds.voxelize = made.voxelize;
  out.seconds.resample = made.resample;
  out.seconds.isosurface = made.isosurface;
  out.seconds.collapse = made.collapse;
  out.resolution = levels->solid().volume.grid.size;
  out.level_resolution = cut->resolution;
  out.voxels_inside = levels->voxels_inside();
  out.fill = levels->fill();
  const std::vector<std::string>& assumed = levels->solid().warnings;
  out.warnings.insert(out.warnings.end(), assumed.begin(), assumed.end());
  if (!levels->by_slabs()) tell_vanished(*levels, model, cut->mesh, cut->resolution, out.warnings);
  if (options.then_collapse) {
    const Result<void> done = collapse(model, options, std::move(cut->mesh), out, task.part(0.3, "collapsing"));
    if (!done) return fail(done.error());
    out.level.seconds = watch.total();
    return out;
  }
  out.shortfall = shortfall_of(options, *cut);
  Level& level = out.level;
  level.triangles = cut->mesh.triangles.size();
  level.method = "voxels";
  level.model = model_of(std::move(cut->mesh), model);
  if (reference && !cut->distance) {
    const Stopwatch measuring;
    const Result<measure::Distance> d =
        reference->distance_to(level.model, options.distance, task.part(0.3, "measuring"));
    if (!d) return fail(d.error());
    cut->distance = *d;
    out.seconds.measure += measuring.total();
  }
  out.measured = cut->distance.has_value();
  if (cut->distance) level.error = detail::level_error(*cut->distance);
  level.seconds = watch.total();
  return out;
}

namespace {

// What each coarser level is to be: a count, or an error.
struct LevelTarget {
  std::size_t triangles = 0;
  double error = 0;
};

std::vector<LevelTarget> targets_of(const LadderOptions& options, std::size_t triangles) {
  std::vector<LevelTarget> out;
  const auto share = [&](double ratio) {
    return std::max<std::size_t>(8, static_cast<std::size_t>(static_cast<double>(triangles) * ratio + 0.5));
  };
  for (const double e : options.errors) out.push_back({0, e});
  for (const std::size_t n : options.triangles) out.push_back({n, 0});
  for (const double r : options.ratios) out.push_back({share(r), 0});
  if (!out.empty()) return out;
  double ratio = 1;
  for (std::size_t i = 1; i < options.levels; ++i) out.push_back({share(ratio *= 0.5), 0});
  return out;
}

Result<void> add_voxel_levels(LadderResult& out, VoxelLevels& levels, const std::vector<LevelTarget>& targets,
                              std::uint32_t guess, const measure::Reference& reference, const LadderOptions& options,
                              std::vector<std::string>& warnings, const Task& task) {
  const Model& original = out.ladder.original;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const Stopwatch making;
    const Task part = task.part(1.0 / static_cast<double>(targets.size()), fmt::format("level {}", i + 1));
    const LevelTarget& target = targets[i];
    Result<VoxelCut> cut = target.error > 0
                               ? detail::find_error(levels, target.error, guess, reference, options.distance, part)
                               : detail::find_count(levels, target.triangles, guess, part);
    if (!cut && cut.error().code == ErrorCode::empty && i > 0) {
      out.shortfalls.push_back({i + 1, cut.error().what});
      break;
    }
    if (!cut) return fail(cut.error());
    RemeshOptions asked;
    asked.triangles = target.triangles;
    asked.error = target.error;
    if (std::string reason = shortfall_of(asked, *cut); !reason.empty()) out.shortfalls.push_back({i + 1, reason});
    guess = std::max<std::uint32_t>(4, target.error > 0 ? cut->resolution / 2 : cut->resolution * 7 / 10);
    tell_vanished(levels, original, cut->mesh, cut->resolution, warnings);
    Level level;
    level.triangles = cut->mesh.triangles.size();
    level.method = "voxels";
    level.model = model_of(std::move(cut->mesh), original);
    const Stopwatch measuring;
    const Result<measure::Distance> d = cut->distance ? Result<measure::Distance>(*cut->distance)
                                                      : reference.distance_to(level.model, options.distance, part);
    if (!d) return fail(d.error());
    out.measure_seconds += measuring.total();
    level.error = detail::level_error(*d, out.ladder.levels.back().error.error);
    level.seconds = making.total();
    out.simplify_seconds += level.seconds - measuring.total();
    out.ladder.levels.push_back(std::move(level));
  }
  return {};
}

}  // namespace

Result<LadderResult> build_voxel_ladder(Model original, const LadderOptions& options, const VoxelOptions& voxel,
                                        bool then_collapse, std::uint32_t resolution,
                                        std::vector<std::string>& warnings, Task task) {
  const std::vector<LevelTarget> targets = targets_of(options, drawn_triangles(original));
  RemeshOptions first;
  first.voxel = voxel;
  first.then_collapse = then_collapse;
  first.resolution = resolution;
  first.triangles = targets.front().triangles;
  first.error = targets.front().error;
  first.distance = options.distance;
  const Result<std::uint32_t> finest = finest_for(original, first, task.part(0.1));
  if (!finest) return fail(finest.error());
  Result<VoxelLevels> levels = VoxelLevels::create(original, voxel, *finest, task.part(0.2));
  if (!levels) return fail(levels.error());
  warnings.insert(warnings.end(), levels->solid().warnings.begin(), levels->solid().warnings.end());
  if (then_collapse) {
    const Result<measure::Reference> reference = measure::Reference::create(original, task);
    if (!reference) return fail(reference.error());
    Result<VoxelCut> start = cut_for(*levels, first, *finest, &*reference, task.part(0.2));
    if (!start) return fail(start.error());
    tell_vanished(*levels, original, start->mesh, start->resolution, warnings);
    LadderOptions collapsing = options;
    collapsing.start = model_of(std::move(start->mesh), original);
    Result<LadderResult> made = build_ladder(std::move(original), collapsing, task.part(0.5));
    if (!made) return made;
    for (std::size_t i = 1; i < made->ladder.levels.size(); ++i) {
      made->ladder.levels[i].method = "voxels and edge collapse";
    }
    return made;
  }
  LadderResult out;
  out.ladder.original = std::move(original);
  const Stopwatch preparing;
  const Result<measure::Reference> reference = measure::Reference::create(out.ladder.original, task.part(0.1));
  if (!reference) return fail(reference.error());
  out.measure_seconds = preparing.total();
  out.ladder.levels.push_back(detail::original_level(out.ladder.original, reference->diagonal()));
  const Result<void> added = add_voxel_levels(out, *levels, targets, std::max<std::uint32_t>(4, *finest * 8 / 9),
                                              *reference, options, warnings, task.part(0.6));
  if (!added) return fail(added.error());
  if (options.image) {
    const Result<void> compared = detail::compare_pictures(out, *options.image, task);
    if (!compared) return fail(compared.error());
  }
  return out;
}

}  // namespace lodestone::chain
