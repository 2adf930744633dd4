#include "lodestone/chain/remesh.h"

#include <fmt/format.h>

#include <algorithm>

#include "lodestone/base/stopwatch.h"
#include "lodestone/chain/level_error_detail.h"
#include "lodestone/spatial/bvh.h"
#include "lodestone/voxel/isosurface.h"
#include "lodestone/voxel/project.h"
#include "lodestone/voxel/resample.h"

namespace lodestone::chain {

namespace {

Result<void> check(const RemeshOptions& options) {
  const auto bad = [](std::string what, std::string remedy) {
    return fail(ErrorCode::bad_argument, std::move(what), {}, std::move(remedy));
  };
  if (options.resolutions.empty()) return bad("no resolution is asked for", "ask for 4 voxels or more");
  if (options.supersample > 64) return bad("more than 64 voxels in one are asked for", "use 1 to 64");
  for (std::size_t i = 0; i < options.resolutions.size(); ++i) {
    const std::uint32_t n = options.resolutions[i];
    if (n < 4 || n > 16'384) return bad(fmt::format("a resolution of {} can't be", n), "use 4 to 16,384");
    if (i > 0 && n >= options.resolutions[i - 1])
      return bad("the resolutions do not fall", "name the finest level first");
  }
  return {};
}

// Size of a level's grid inside the solid's: a whole number of its voxels each where the finest has `supersample`.
std::array<std::uint32_t, 3> level_size(const VoxelGrid& solid, std::uint32_t longest, std::uint32_t resolution) {
  std::array<std::uint32_t, 3> size{};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint64_t wanted = (std::uint64_t{solid.size[k]} * resolution + longest / 2) / longest;
    size[k] = std::clamp<std::uint32_t>(static_cast<std::uint32_t>(wanted), 1, solid.size[k]);
  }
  return size;
}

Result<Mesh> contour(const BitVolume& solid, std::uint32_t resolution, const spatial::Bvh& source,
                     const RemeshOptions& options, RemeshSeconds& seconds, const Task& task) {
  Stopwatch watch;
  const auto& size = solid.grid.size;
  const std::uint32_t longest = *std::max_element(size.begin(), size.end());
  const auto shares = voxel::downsample(solid, level_size(solid.grid, longest, resolution), task);
  if (!shares) return fail(shares.error());
  seconds.resample += watch.lap();
  Result<Mesh> mesh = voxel::isosurface(*shares, {127.5}, task);
  if (!mesh && mesh.error().code == ErrorCode::empty) {
    return fail(ErrorCode::empty,
                fmt::format("no part is half as thick as a voxel of {} along the longest side", resolution), {},
                "raise --resolution");
  }
  if (!mesh) return fail(mesh.error());
  const Vec3d voxel = shares->grid.spacing;
  if (options.project) voxel::project(*mesh, source, std::max({voxel.x, voxel.y, voxel.z}), task);
  if (task.cancelled()) return cancelled_error("remeshing");
  seconds.isosurface += watch.lap();
  return mesh;
}

}  // namespace

Result<RemeshResult> remesh(const Model& model, const RemeshOptions& options, Task task) {
  if (const Result<void> ok = check(options); !ok) return fail(ok.error());
  RemeshResult out;
  Stopwatch watch;
  const Result<FillChoice> choice = choose_fill(model, options.fill, task.part(0.1));
  if (!choice) return fail(choice.error());
  const std::uint32_t usual = choice->fill == voxel::FillRule::winding ? 2 : 4;
  const std::uint32_t supersample = options.supersample > 0 ? options.supersample : usual;
  SolidOptions solid_options;
  solid_options.resolution = options.resolutions.front() * supersample;
  solid_options.margin = solid_options.multiple = supersample;  // whole voxels of the finest level
  const Result<Solid> solid = solid_of(model, *choice, solid_options, task.part(0.3));
  if (!solid) return fail(solid.error());
  out.seconds.voxelize = solid->seconds.slicing + solid->seconds.filling;
  out.resolution = solid->volume.grid.size;
  out.voxels_inside = solid->volume.set_count();
  out.fill = *choice;
  out.warnings = solid->warnings;

  const spatial::Bvh source(solid->surface, task);
  out.seconds.prepare = watch.total() - out.seconds.voxelize;
  std::optional<measure::Reference> reference;
  if (options.measure) {
    Result<measure::Reference> made = measure::Reference::create(model, task.part(0.1));
    if (!made) return fail(made.error());
    reference.emplace(std::move(*made));
  }
  for (const std::uint32_t resolution : options.resolutions) {
    const Stopwatch making;
    const Task part =
        task.part(0.5 / static_cast<double>(options.resolutions.size()), fmt::format("{} voxels", resolution));
    Result<Mesh> mesh = contour(solid->volume, resolution, source, options, out.seconds, part);
    if (!mesh) return fail(mesh.error());
    Level level;
    level.triangles = mesh->triangles.size();
    level.method = "voxels";
    level.model = make_model(std::move(*mesh));
    level.model.meters_per_unit = model.meters_per_unit;
    if (reference) {
      const Stopwatch measuring;
      const Result<measure::Distance> d = reference->distance_to(level.model, options.distance, part);
      if (!d) return fail(d.error());
      level.error = detail::level_error(*d, out.levels.empty() ? 0 : out.levels.back().error.error);
      out.seconds.measure += measuring.total();
    }
    level.seconds = making.total();
    out.levels.push_back(std::move(level));
  }
  return out;
}

}  // namespace lodestone::chain
