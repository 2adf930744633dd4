// Which resolution gives a wanted number of triangles, or a wanted error.
//
// The triangles of a surface by voxels grow with the square of the resolution ([voxel-lod], section 3.4), and its error
// falls roughly with the inverse of it.
// 1. finest_for() says how fine the solid must be. For a count, growth_of() contours coarse solids until one has
//    triangles enough to count. start_triangles() says how many triangles a surface needs that is collapsed afterwards.
// 2. cut_for() makes the surface. find_count() and find_error() step by these laws, between a resolution that is too
//    coarse and one that is too fine, until they meet a count within a tenth from below, or an error with a bracket
//    within four per cent of the resolution. They give up after eight and twelve tries.
// 3. shortfall_of() and tell_vanished() put into words what was missed.
//
// A count is never exceeded by find_count(), and a surface for an error was measured within it; else a shortfall says
// so. The same for any number of threads. Cost: that of the surfaces tried, and for errors of measuring them.
#include "lodestone/chain/ladder/level_error_detail.h"
#include "lodestone/chain/voxels/voxel_search_detail.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lodestone/base/units.h"

namespace lodestone::chain::detail {

namespace {

constexpr std::uint32_t kLeast = 4, kMost = 16'384;
constexpr std::uint32_t kUsual = 128;
constexpr std::uint32_t kMostForError = 512;  // for finer surfaces a resolution must be given

// How fine a surface must be that is collapsed afterwards, so that the voxels add little to the target's error. Where
// holes are closed, fine solids cost too much, and thin sheets get a topology that no collapse can undo.
constexpr std::size_t kStart = 16, kLeastStart = 200'000, kMostStart = 4'000'000, kStartOfOpen = 8;
constexpr double kStartError = 3;

std::uint32_t clamped(double resolution, std::uint32_t most) {
  return static_cast<std::uint32_t>(
      std::clamp(resolution + 0.5, static_cast<double>(kLeast), static_cast<double>(most)));
}

// A surface at resolution r has about `per_square` r² triangles.
struct Growth {
  double per_square = 0;  // 0: even fine solids leave too few triangles to count
  voxel::FillRule fill = voxel::FillRule::parity;
};

Result<Growth> growth_of(const Model& model, const VoxelOptions& options, const Task& task) {
  VoxelOptions quick = options;
  quick.supersample = quick.fill == voxel::FillRule::winding ? 1 : 2;
  Growth growth;
  for (std::uint32_t resolution = 48; resolution <= 384; resolution *= 2) {
    Result<VoxelLevels> levels = VoxelLevels::create(model, quick, resolution, task);
    if (!levels && (levels.error().code != ErrorCode::empty || resolution == 384)) return fail(levels.error());
    if (!levels) continue;
    growth.fill = levels->fill().fill;
    const Result<Mesh> mesh = levels->surface_at(resolution, task);
    if (!mesh && mesh.error().code != ErrorCode::empty) return fail(mesh.error());
    if (!mesh || mesh->triangles.size() < 200) continue;
    growth.per_square = static_cast<double>(mesh->triangles.size()) / resolution / resolution;
    break;
  }
  return growth;
}

std::size_t start_triangles(std::size_t target, voxel::FillRule fill) {
  const bool closed = fill == voxel::FillRule::parity || fill == voxel::FillRule::nonzero;
  const std::size_t wanted =
      closed ? std::clamp(target * kStart, kLeastStart, kMostStart) : std::min(target * kStartOfOpen, kMostStart);
  return std::max(wanted, target);
}

Result<VoxelCut> cut_at(VoxelLevels& levels, std::uint32_t resolution, const Task& task) {
  Result<Mesh> mesh = levels.surface_at(resolution, task);
  LODESTONE_TRY(mesh);
  return VoxelCut{resolution, std::move(*mesh), {}};
}

Result<VoxelCut> find_count(VoxelLevels& levels, std::size_t triangles, std::uint32_t guess, const Task& task) {
  const auto wanted = static_cast<double>(triangles);
  VoxelCut best;
  std::uint32_t resolution = std::clamp(guess, kLeast, levels.most_resolution());
  std::uint32_t above = levels.most_resolution() + 1, below = kLeast - 1;  // too many triangles, and not
  for (int turn = 0; turn < 8; ++turn) {
    Result<Mesh> mesh = levels.surface_at(resolution, task);
    if (!mesh && mesh.error().code != ErrorCode::empty) return fail(mesh.error());
    const double count = mesh ? static_cast<double>(mesh->triangles.size()) : 0;
    if (count <= wanted) {
      below = resolution;
      if (mesh && mesh->triangles.size() > best.mesh.triangles.size()) best = {resolution, std::move(*mesh), {}};
      if (count >= 0.9 * wanted) return best;
    } else {
      above = resolution;
    }
    if (above <= below + 1) break;
    constexpr double kAim = 0.96;  // of the count, so that it is not missed by a little
    const double next = count > 0 ? resolution * std::sqrt(kAim * wanted / count) : resolution * 2.0;
    resolution = std::clamp(clamped(next, levels.most_resolution()), below + 1, above - 1);
  }
  if (best.resolution == 0) {
    return fail(ErrorCode::empty, "no surface with so few triangles has anything left", {}, "ask for more triangles");
  }
  return best;
}

Result<VoxelCut> find_error(VoxelLevels& levels, double limit, std::uint32_t guess, const measure::Reference& reference,
                            const measure::DistanceOptions& distance, const Task& task) {
  std::optional<VoxelCut> best;
  VoxelCut finest;
  std::uint32_t resolution = std::clamp(guess, kLeast, levels.most_resolution());
  std::uint32_t good = levels.most_resolution() + 1, bad = kLeast - 1;
  for (int turn = 0; turn < 12; ++turn) {
    VoxelCut cut;
    cut.resolution = resolution;
    Result<Mesh> mesh = levels.surface_at(resolution, task);
    if (!mesh && mesh.error().code != ErrorCode::empty) return fail(mesh.error());
    double error = 0;
    if (mesh) {
      cut.mesh = std::move(*mesh);
      const Result<measure::Distance> d = reference.distance_to(make_model(cut.mesh), of_valid(distance), task);
      LODESTONE_TRY(d);
      cut.distance = *d;
      error = d->trusted_max();
    }
    const bool holds = mesh && error <= limit;
    if (holds) {
      good = resolution;
      best = std::move(cut);
    } else {
      bad = resolution;
      if (mesh && resolution > finest.resolution) finest = std::move(cut);
    }
    // Some 4 % of the resolution are 8 % of the triangles.
    if (good <= bad + 1 || (best && bad >= kLeast && good * 100 <= bad * 104)) break;
    const bool between = best && bad >= kLeast;
    const double step = mesh ? std::clamp(error / limit, 0.25, 4.0) : 2.0;
    const double next = between ? std::sqrt(static_cast<double>(good) * bad) : resolution * step;
    resolution = std::clamp(clamped(next, levels.most_resolution()), bad + 1, good - 1);
  }
  if (best) return std::move(*best);
  if (finest.resolution == 0) {
    return fail(ErrorCode::empty, "no part is half as thick as a voxel", {}, "raise `resolution`");
  }
  return finest;
}

}  // namespace

Result<std::uint32_t> finest_for(const Model& model, const VoxelOptions& options, const VoxelTarget& target,
                                 const Task& task) {
  if (target.resolution > 0) return target.resolution;
  if (target.triangles == 0) return target.error > 0 ? kMostForError : kUsual;
  const Result<Growth> growth = growth_of(model, options, task);
  LODESTONE_TRY(growth);
  if (!(growth->per_square > 0)) return kUsual;
  const std::size_t wanted = target.then_collapse ? start_triangles(target.triangles, growth->fill) : target.triangles;
  const double predicted = std::sqrt(static_cast<double>(wanted) / growth->per_square);
  constexpr double kRoom = 1.125;  // for predictions that are a little low
  return std::max<std::uint32_t>(8, clamped(target.then_collapse ? predicted : kRoom * predicted, kMost));
}

bool needs_reference(const VoxelTarget& target) { return target.error > 0 && target.resolution == 0; }

Result<VoxelCut> cut_for(VoxelLevels& levels, const VoxelTarget& target, std::uint32_t finest,
                         const measure::Reference* reference, const measure::DistanceOptions& distance,
                         const Task& task) {
  if (target.resolution > 0) return cut_at(levels, finest, task);
  if (target.error > 0) {
    const double limit = target.then_collapse ? target.error / kStartError : target.error;
    return find_error(levels, limit, target.then_collapse ? kUsual : kUsual / 2, *reference, distance, task);
  }
  if (target.then_collapse || target.triangles == 0) return cut_at(levels, finest, task);
  return find_count(levels, target.triangles, finest * 8 / 9, task);
}

std::string shortfall_of(const VoxelTarget& target, const VoxelCut& cut) {
  const std::size_t count = cut.mesh.triangles.size();
  if (target.triangles > 0 && (count > target.triangles || count * 10 < target.triangles * 9)) {
    return fmt::format("{} triangles were asked for, {} are the nearest that a resolution gives",
                       with_separators(target.triangles), with_separators(count));
  }
  if (target.error > 0 && cut.distance && cut.distance->trusted_max() > target.error) {
    return fmt::format("no resolution up to {} has a measured error within {:.6g}", cut.resolution, target.error);
  }
  return {};
}

void tell_vanished(const VoxelLevels& levels, const Model& model, const VoxelCut& cut,
                   std::vector<std::string>& warnings) {
  const std::vector<std::string> gone = levels.vanished(model, cut.mesh, cut.resolution);
  if (gone.empty()) return;
  constexpr std::size_t kNamed = 4;
  const auto end = gone.begin() + static_cast<std::ptrdiff_t>(std::min(kNamed, gone.size()));
  warnings.push_back(fmt::format("{} of the model's pieces vanished, as they are thinner than a voxel: {}{}",
                                 with_separators(gone.size()), fmt::join(gone.begin(), end, "; "),
                                 gone.size() > kNamed ? "; ..." : ""));
}

}  // namespace lodestone::chain::detail
