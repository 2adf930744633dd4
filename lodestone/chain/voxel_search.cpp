#include <algorithm>
#include <cmath>

#include "lodestone/chain/voxel_search_detail.h"

namespace lodestone::chain::detail {

namespace {

constexpr std::uint32_t kLeast = 4, kMost = 16'384;

std::uint32_t clamped(double resolution, std::uint32_t most) {
  return static_cast<std::uint32_t>(
      std::clamp(resolution + 0.5, static_cast<double>(kLeast), static_cast<double>(most)));
}

}  // namespace

Result<std::uint32_t> predict_resolution(const Model& model, const VoxelOptions& options, std::size_t triangles,
                                         const Task& task) {
  VoxelOptions quick = options;
  quick.supersample = 2;
  if (quick.fill == voxel::FillRule::winding) quick.supersample = 1;
  for (std::uint32_t resolution = 48; resolution <= 384; resolution *= 2) {
    Result<VoxelLevels> levels = VoxelLevels::create(model, quick, resolution, task);
    if (!levels && (levels.error().code != ErrorCode::empty || resolution == 384)) return fail(levels.error());
    if (!levels) continue;
    const Result<Mesh> mesh = levels->surface_at(resolution, task);
    if (!mesh && mesh.error().code != ErrorCode::empty) return fail(mesh.error());
    if (!mesh || mesh->triangles.size() < 200) continue;
    const double count = static_cast<double>(mesh->triangles.size());
    return clamped(resolution * std::sqrt(static_cast<double>(triangles) / count), kMost);
  }
  return 128;
}

Result<VoxelCut> find_count(VoxelLevels& levels, std::size_t triangles, std::uint32_t guess, const Task& task) {
  const auto wanted = static_cast<double>(triangles);
  VoxelCut best;
  std::uint32_t resolution = std::clamp(guess, kLeast, levels.most_resolution());
  std::uint32_t above = levels.most_resolution() + 1, below = kLeast - 1;  // counts too large, and not
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
      const Result<measure::Distance> d = reference.distance_to(make_model(cut.mesh), distance, task);
      if (!d) return fail(d.error());
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
    return fail(ErrorCode::empty, "no part is half as thick as a voxel", {}, "raise --resolution");
  }
  return finest;
}

}  // namespace lodestone::chain::detail
