// Ladders whose levels are new surfaces made from voxels, all from one solid ([voxel-lod], section 2.2).
//
// build_voxel_ladder():
// 1. targets_of(): a count or an error for each level. finest_for() says which resolution the first, the finest, needs,
//    and VoxelLevels::create() makes a solid that is fine enough for it.
// 2. separate_levels(): add_levels() contours a surface for each target (cut_for()) and measures it (make_level()).
//    The search for a level starts from the resolution of the level before.
//    collapse_levels(), with `then_collapse`: one fine surface, from which build_ladder() collapses all levels.
// 3. add_attributes(): normals and colours, or textures, from the original.
// 4. compare_pictures(), where pictures are asked for, only now that the levels have their colours.
//
// Every level is measured against the original, not against the fine surface, and errors never fall (level_error()).
// A target that no resolution reaches is a Shortfall; where nothing is left at all, the ladder ends. The same bytes for
// any number of threads. Cost: one fine voxelization, a surface for each resolution that is tried, and a measurement of
// each level; for errors, of each surface that is tried.
#include "lodestone/chain/voxels/voxel_ladder.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "lodestone/base/stopwatch.h"
#include "lodestone/chain/ladder/ladder_detail.h"
#include "lodestone/chain/ladder/level_error_detail.h"
#include "lodestone/chain/voxels/voxel_search_detail.h"

namespace lodestone::chain {

using detail::VoxelCut;
using detail::VoxelTarget;
using measure::Reference;

namespace {

std::vector<VoxelTarget> targets_of(const LadderOptions& options, std::size_t drawn) {
  std::vector<VoxelTarget> out;
  for (const double error : options.errors) out.push_back({0, 0, error, false});
  if (!out.empty()) return out;
  for (const std::size_t count : detail::count_targets(options, drawn)) out.push_back({0, count, 0, false});
  return out;
}

Result<Level> make_level(VoxelCut cut, const Model& original, double finer_error, const Reference& reference,
                         const measure::DistanceOptions& distance, double& measure_seconds, const Task& task) {
  Level level;
  level.triangles = cut.mesh.triangles.size();
  level.method = "voxels";
  level.model = make_model(std::move(cut.mesh), original);
  if (!cut.distance) {
    const Stopwatch measuring;
    Result<measure::Distance> d = reference.distance_to(level.model, detail::of_valid(distance), task);
    LODESTONE_TRY(d);
    cut.distance = *d;
    measure_seconds += measuring.total();
  }
  level.error = detail::level_error(*cut.distance, finer_error);
  return level;
}

Result<void> add_levels(LadderResult& out, VoxelLevels& levels, const std::vector<VoxelTarget>& targets,
                        std::uint32_t finest, const Reference& reference, const LadderOptions& options,
                        const Task& task) {
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const Stopwatch making;
    const Task part = task.part(1.0 / static_cast<double>(targets.size()), fmt::format("level {}", i + 1));
    Result<VoxelCut> cut = detail::cut_for(levels, targets[i], finest, &reference, options.distance, part);
    if (!cut && cut.error().code == ErrorCode::empty && i > 0) {
      out.shortfalls.push_back({i + 1, cut.error().what, ShortfallCause::not_reached_by_voxels});
      break;
    }
    LODESTONE_TRY(cut);
    if (std::string reason = detail::shortfall_of(targets[i], *cut); !reason.empty()) {
      out.shortfalls.push_back({i + 1, std::move(reason), ShortfallCause::not_reached_by_voxels});
    }
    detail::tell_vanished(levels, out.ladder.original, *cut, out.warnings);
    finest = std::max<std::uint32_t>(8, cut->resolution * 4 / 5);  // half the triangles, with some room
    const double before = out.measure_seconds;
    Result<Level> level = make_level(std::move(*cut), out.ladder.original, out.ladder.levels.back().error.error,
                                     reference, options.distance, out.measure_seconds, part);
    LODESTONE_TRY(level);
    level->seconds = making.total();
    out.simplify_seconds += level->seconds - (out.measure_seconds - before);
    out.ladder.levels.push_back(std::move(*level));
  }
  return {};
}

// One fine surface, and a ladder of that.
Result<LadderResult> collapse_levels(Model original, const LadderOptions& options, VoxelLevels& levels,
                                     const VoxelTarget& first, std::uint32_t finest, const Task& task) {
  std::optional<Reference> reference;
  if (detail::needs_reference(first)) {
    Result<Reference> made = Reference::create(original, task);
    LODESTONE_TRY(made);
    reference.emplace(std::move(*made));
  }
  const Reference* known = reference ? &*reference : nullptr;
  Result<VoxelCut> start = detail::cut_for(levels, first, finest, known, options.distance, task.part(0.3));
  LODESTONE_TRY(start);
  std::vector<std::string> warnings = levels.solid().warnings;
  detail::tell_vanished(levels, original, *start, warnings);
  LadderOptions collapsing = options;
  collapsing.start = make_model(std::move(start->mesh), original);
  Result<LadderResult> made = build_ladder(std::move(original), collapsing, task.part(0.7));
  if (!made) return made;
  for (std::size_t i = 1; i < made->ladder.levels.size(); ++i) {
    made->ladder.levels[i].method = "voxels and edge collapse";
  }
  made->warnings.insert(made->warnings.begin(), warnings.begin(), warnings.end());
  return made;
}

// Each level a surface of its own.
Result<LadderResult> separate_levels(Model original, const LadderOptions& options, VoxelLevels& levels,
                                     const std::vector<VoxelTarget>& targets, std::uint32_t finest, const Task& task) {
  LadderResult out;
  out.warnings = levels.solid().warnings;
  out.ladder.original = std::move(original);
  const Stopwatch preparing;
  const Result<Reference> reference = Reference::create(out.ladder.original, task.part(0.1));
  LODESTONE_TRY(reference);
  out.measure_seconds = preparing.total();
  out.ladder.levels.push_back(detail::original_level(out.ladder.original, reference->diagonal()));
  LODESTONE_TRY(add_levels(out, levels, targets, finest, *reference, options, task.part(0.9)));
  return out;
}

Result<void> add_attributes(Ladder& ladder, const AttributeSource& source, const Task& task) {
  for (std::size_t level = 1; level < ladder.levels.size(); ++level) {
    LODESTONE_TRY(source.add_to(ladder.levels[level].model, level, task));
  }
  return {};
}

}  // namespace

Result<LadderResult> build_voxel_ladder(Model original, const LadderOptions& options, const VoxelLadderOptions& voxels,
                                        Task task) {
  LODESTONE_TRY(detail::check_ladder(original, options, task));
  if (original.meshes.size() != 1 || original.instances.size() != 1) {
    return fail(ErrorCode::bad_argument, "levels by voxels need an original of one mesh", {},
                "flatten the scene first");
  }
  const Result<AttributeSource> source = AttributeSource::create(original, voxels.attributes, task.part(0.1));
  LODESTONE_TRY(source);
  const std::vector<VoxelTarget> targets = targets_of(options, drawn_triangles(original));
  VoxelTarget first = targets.front();
  first.then_collapse = voxels.then_collapse;
  first.resolution = voxels.resolution;
  const Result<std::uint32_t> finest = detail::finest_for(original, voxels.voxel, first, task.part(0.1));
  LODESTONE_TRY(finest);
  Result<VoxelLevels> levels = VoxelLevels::create(original, voxels.voxel, *finest, task.part(0.1));
  LODESTONE_TRY(levels);
  LadderOptions without_pictures = options;  // they are compared when the levels have their colours
  without_pictures.image.reset();
  const Task making = task.part(options.image ? 0.4 : 0.6);
  Result<LadderResult> out =
      voxels.then_collapse ? collapse_levels(std::move(original), without_pictures, *levels, first, *finest, making)
                           : separate_levels(std::move(original), without_pictures, *levels, targets, *finest, making);
  if (!out) return out;
  LODESTONE_TRY(add_attributes(out->ladder, *source, task));
  if (options.image) {
    LODESTONE_TRY(detail::compare_pictures(*out, *options.image, task.part(0.2, "comparing pictures")));
  }
  return out;
}

}  // namespace lodestone::chain
