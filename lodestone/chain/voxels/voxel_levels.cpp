// Surfaces of one model at any resolution, all from one voxelization ([voxel-lod], section 2.2; docs/papers/voxel.md).
//
// 1. create() makes a Solid (solid.h) with `supersample` voxels along each side of a voxel of the finest level. Where
//    that does not fit into memory (needs_slabs()), of_grid() keeps the model's surface alone; surface_by_slabs() then
//    makes the voxels slab by slab for each level.
// 2. surface_at() makes a level: even_surface_at() resamples the solid to the level's resolution and contours it, in
//    the way that `placement` says:
//    - edge_ratio: the march along the edge of the paper (section 2.4.4),
//    - linear, project: Marching Cubes [lorensen-cline-1987] where the share of each voxel that is inside reaches a
//      half; project then moves vertices to the model. With keep_volume, contour_of_volume() bisects for the iso whose
//      surface encloses the solid's volume.
//    - sharp: one vertex in each cut cube, on the model's edges and corners.
//    With `adaptive`, edges are then collapsed as long as the surface moves by less than that share of a voxel.
// 3. vanished() names the model's pieces of which no vertex lies within a voxel of the surface.
//
// The solid never changes, so levels do not depend on each other. The same bytes for any number of threads. A level
// costs O(voxels of the solid) to resample, and O(log n) for each vertex that is moved to the model.
#include "lodestone/chain/voxels/voxel_levels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lodestone/base/stopwatch.h"
#include "lodestone/base/units.h"
#include "lodestone/core/parts.h"
#include "lodestone/core/validate.h"
#include "lodestone/simplify/collapse/edge_collapse.h"
#include "lodestone/voxel/edge_ratio.h"
#include "lodestone/voxel/isosurface.h"
#include "lodestone/voxel/project.h"
#include "lodestone/voxel/resample.h"
#include "lodestone/voxel/sharp_surface.h"
#include "lodestone/voxel/slab_surface.h"

namespace lodestone::chain {

namespace {

constexpr double kHalf = 127.5;  // of shares from 0 to 255

Result<void> check(const VoxelOptions& options, std::uint32_t finest) {
  const auto bad = [](std::string what, std::string remedy) {
    return fail(ErrorCode::bad_argument, std::move(what), {}, std::move(remedy));
  };
  if (options.supersample > 64) return bad("more than 64 voxels in one are asked for", "use 1 to 64");
  if (!(options.adaptive >= 0 && options.adaptive <= 10)) return bad("such a share of a voxel can't be", "use 0 to 10");
  if (options.close < 0) return bad("a radius below 0 is asked for", "use one above");
  if (finest < 4 || finest > 16'384) return bad(fmt::format("a resolution of {} can't be", finest), "use 4 to 16,384");
  return {};
}

// Above this a solid and the shares of a level are not kept in memory as a whole.
constexpr double kWholeBytes = 1.2e9;

bool needs_slabs(const VoxelGrid& grid, std::uint32_t supersample, const VoxelOptions& options,
                 const FillChoice& choice) {
  const auto voxels = static_cast<double>(grid.count());
  const double ratio = static_cast<double>(supersample) * supersample * supersample;
  const bool can =
      options.placement == VertexPlacement::project && !options.keep_thin && choice.fill != voxel::FillRule::shrinkwrap;
  return can && voxels / 8 + 1.2 * voxels / ratio > kWholeBytes;
}

// The iso at which the surface encloses a volume: halving between 1 and 254.
Result<Mesh> contour_of_volume(const ScalarVolume<std::uint8_t>& shares, double wanted, const Task& task) {
  double low = 1, high = 254;
  std::optional<Mesh> best;
  double best_off = 0;
  double iso = kHalf;
  for (int turn = 0; turn < 10; ++turn) {
    Result<Mesh> mesh = voxel::isosurface(shares, {iso}, task);
    if (!mesh && mesh.error().code != ErrorCode::empty) return mesh;
    const double volume = mesh ? volume_of(*mesh) : 0;
    const double off = std::abs(volume - wanted);
    if (mesh && (!best || off < best_off)) {
      best = std::move(*mesh);
      best_off = off;
    }
    if (best && best_off <= 1e-4 * wanted) break;
    (volume > wanted ? low : high) = iso;
    iso = (low + high) / 2;
  }
  if (!best) return fail(ErrorCode::empty, "no voxel is inside");
  return std::move(*best);
}

std::string name_of_part(const Model& model, const Instance& instance, std::size_t part, Vec3d at) {
  const Mesh& mesh = model.meshes[instance.mesh];
  const std::string& name = instance.name.empty() ? mesh.name : instance.name;
  return fmt::format("{}piece {} at ({}, {}, {})", name.empty() ? "" : "'" + name + "', ", part + 1, short_number(at.x),
                     short_number(at.y), short_number(at.z));
}

}  // namespace

Result<VoxelLevels> VoxelLevels::create(const Model& model, const VoxelOptions& options, std::uint32_t finest,
                                        Task task) {
  LODESTONE_TRY(check(options, finest));
  Stopwatch watch;
  Result<FillChoice> choice = choose_fill(model, options.fill, task.part(0.2));
  LODESTONE_TRY(choice);
  choice->close = options.close;
  const bool slow = choice->fill == voxel::FillRule::winding || choice->fill == voxel::FillRule::shrinkwrap;
  const std::uint32_t usual = slow ? 2 : 4;
  const std::uint32_t supersample = options.supersample > 0 ? options.supersample : usual;
  SolidOptions solid_options;
  solid_options.resolution = finest * supersample;
  solid_options.margin = solid_options.multiple = supersample;  // whole voxels of the finest level
  Result<VoxelGrid> grid = solid_grid(bounds_of(model), *choice, solid_options);
  LODESTONE_TRY(grid);
  if (needs_slabs(*grid, supersample, options, *choice)) {
    Result<VoxelLevels> slabs = of_grid(model, *grid, *choice, options, task);
    if (slabs) slabs->seconds_.prepare = watch.total();
    return slabs;
  }
  Result<Solid> solid = solid_in(model, *choice, *grid, task.part(0.6));
  LODESTONE_TRY(solid);
  Result<VoxelLevels> made = of_valid(std::move(*solid), *choice, options, task);
  if (!made) return made;
  made->seconds_.prepare = watch.total() - made->seconds_.voxelize;
  return made;
}

// The surface alone, for solids that are made slab by slab.
Result<VoxelLevels> VoxelLevels::of_grid(const Model& model, const VoxelGrid& grid, const FillChoice& fill,
                                         const VoxelOptions& options, const Task& task) {
  Solid solid;
  Result<spatial::Surface> surface = spatial::flatten(model, task);
  LODESTONE_TRY(surface);
  solid.surface = std::move(*surface);
  solid.volume.grid = grid;
  Result<VoxelLevels> out = of_valid(std::move(solid), fill, options, task);
  if (out) out->slabs_ = true;
  return out;
}

// By slabs vertices lie half way between voxels before they are projected.
Result<Mesh> VoxelLevels::surface_by_slabs(std::uint32_t resolution, const Task& task) {
  const VoxelGrid& grid = solid_->volume.grid;
  const std::uint32_t ratio = most_resolution() / resolution;
  if (ratio * resolution != most_resolution()) {
    return fail(ErrorCode::bad_argument, fmt::format("a resolution of {} can't be made slab by slab", resolution), {},
                "ask for `resolution` alone");
  }
  std::array<std::uint32_t, 3> size{};
  for (std::size_t k = 0; k < 3; ++k) size[k] = grid.size[k] / ratio;
  VoxelGrid level = grid;
  level.size = size;
  LODESTONE_TRY(check_memory(level, 0.2));
  Result<voxel::SlabSurface> made =
      voxel::slab_surface(solid_->surface, grid, size, {fill_.fill, 0, Input::valid}, task);
  LODESTONE_TRY(made);
  Stopwatch watch;
  voxel::project(made->mesh, *source_, grid.spacing.x * ratio, task);
  if (task.cancelled()) return cancelled_error("remeshing");
  voxels_inside_ = made->voxels_inside;
  solid_->warnings = assumptions(fill_, made->leaking_columns);
  seconds_.voxelize += made->voxelize_seconds;
  seconds_.resample += made->resample_seconds;
  seconds_.isosurface += made->isosurface_seconds + watch.lap();
  return std::move(made->mesh);
}

Result<VoxelLevels> VoxelLevels::of_solid(Solid solid, const FillChoice& fill, const VoxelOptions& options, Task task) {
  LODESTONE_TRY(validate(solid.volume));
  LODESTONE_TRY(validate(solid.surface, task));
  return of_valid(std::move(solid), fill, options, task);
}

Result<VoxelLevels> VoxelLevels::of_valid(Solid solid, const FillChoice& fill, const VoxelOptions& options,
                                          const Task& task) {
  VoxelLevels out;
  out.options_ = options;
  out.fill_ = fill;
  out.solid_ = std::make_unique<Solid>(std::move(solid));
  out.voxels_inside_ = out.solid_->volume.set_count();
  out.source_ = std::make_unique<spatial::Bvh>(out.solid_->surface, task);
  out.seconds_.voxelize = out.solid_->seconds.slicing + out.solid_->seconds.filling;
  if (task.cancelled()) return cancelled_error("remeshing");
  return out;
}

std::uint32_t VoxelLevels::most_resolution() const {
  const auto& size = solid_->volume.grid.size;
  return *std::max_element(size.begin(), size.end());
}

std::array<std::uint32_t, 3> VoxelLevels::size_at(std::uint32_t resolution) const {
  const auto& solid = solid_->volume.grid.size;
  const std::uint32_t longest = most_resolution();
  std::array<std::uint32_t, 3> size{};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint64_t wanted = (std::uint64_t{solid[k]} * resolution + longest / 2) / longest;
    size[k] = std::clamp<std::uint32_t>(static_cast<std::uint32_t>(wanted), 1, solid[k]);
  }
  return size;
}

Result<Mesh> VoxelLevels::surface_at(std::uint32_t resolution, Task task) {
  Result<Mesh> mesh = even_surface_at(resolution, task);
  if (!mesh || !(options_.adaptive > 0)) return mesh;
  const Stopwatch watch;
  simplify::EdgeCollapseOptions options;
  const double voxel = solid_->volume.grid.spacing.x * most_resolution() / resolution;
  options.max_error = options_.adaptive * voxel;
  options.input = Input::valid;
  Result<simplify::EdgeCollapseResult> merged = simplify::collapse_edges(*mesh, options, task);
  LODESTONE_TRY(merged);
  seconds_.collapse += watch.total();
  return std::move(merged->mesh);
}

Result<Mesh> VoxelLevels::even_surface_at(std::uint32_t resolution, const Task& task) {
  if (resolution < 4 || resolution > most_resolution()) {
    return fail(ErrorCode::bad_argument, fmt::format("a resolution of {} can't be", resolution), {},
                fmt::format("use 4 to {}", most_resolution()));
  }
  if (slabs_) return surface_by_slabs(resolution, task);
  const BitVolume& bits = solid_->volume;
  const std::array<std::uint32_t, 3> size = size_at(resolution);
  VoxelGrid level = bits.grid;
  level.size = size;
  LODESTONE_TRY(check_memory(level, 1.2));
  Stopwatch watch;
  const auto thin = [&](Error error) {
    if (error.code != ErrorCode::empty) return fail(std::move(error));
    return fail(ErrorCode::empty,
                fmt::format("no part is half as thick as a voxel of {} along the longest side", resolution), {},
                "raise `resolution`, or use `keep_thin`");
  };
  if (options_.placement == VertexPlacement::edge_ratio) {
    Result<Mesh> mesh = voxel::edge_ratio_surface(bits, size, {}, task);
    seconds_.isosurface += watch.lap();
    return mesh ? std::move(mesh) : Result<Mesh>(thin(mesh.error()));
  }
  const auto shares =
      options_.keep_thin ? voxel::downsample_thin(bits, size, task) : voxel::downsample(bits, size, task);
  LODESTONE_TRY(shares);
  seconds_.resample += watch.lap();
  const Vec3d voxel = shares->grid.spacing;
  const double longest = std::max({voxel.x, voxel.y, voxel.z});
  if (options_.placement == VertexPlacement::sharp) {
    Result<voxel::SharpSurface> sharp = voxel::sharp_surface(*shares, *source_, {}, task);
    seconds_.isosurface += watch.lap();
    return sharp ? Result<Mesh>(std::move(sharp->mesh)) : Result<Mesh>(thin(sharp.error()));
  }
  const Vec3d small = bits.grid.spacing;
  const double volume = static_cast<double>(voxels_inside_) * small.x * small.y * small.z;
  const bool by_volume = options_.keep_volume && options_.placement == VertexPlacement::linear;
  Result<Mesh> mesh = by_volume ? contour_of_volume(*shares, volume, task) : voxel::isosurface(*shares, {kHalf}, task);
  if (!mesh) return thin(mesh.error());
  if (options_.placement == VertexPlacement::project) voxel::project(*mesh, *source_, longest, task);
  if (task.cancelled()) return cancelled_error("remeshing");
  seconds_.isosurface += watch.lap();
  return mesh;
}

std::vector<std::string> VoxelLevels::vanished(const Model& model, const Mesh& surface,
                                               std::uint32_t resolution) const {
  const Result<spatial::Surface> flat = spatial::flatten(make_model(surface), Input::valid);
  if (!flat) return {};
  const spatial::Bvh tree(*flat);
  const double voxel = solid_->volume.grid.spacing.x * most_resolution() / resolution;
  const double near_sq = voxel * voxel;
  std::vector<std::string> out;
  for (const Instance& instance : model.instances) {
    const Mesh& mesh = model.meshes[instance.mesh];
    const Parts parts = parts_of(mesh);
    if (parts.count < 2 && model.instances.size() < 2) continue;
    std::vector<std::uint8_t> seen(parts.count, 0);
    std::vector<std::uint32_t> first(parts.count, kNone);
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
      const std::uint32_t part = parts.of_vertex[v];
      if (part == kNone || seen[part] != 0) continue;
      if (first[part] == kNone) first[part] = v;
      const spatial::Nearest n = tree.closest(instance.transform.point(mesh.position(v)));
      if (n.distance_sq <= near_sq) seen[part] = 1;
    }
    for (std::size_t p = 0; p < parts.count; ++p) {
      if (seen[p] != 0 || first[p] == kNone) continue;
      out.push_back(name_of_part(model, instance, p, instance.transform.point(mesh.position(first[p]))));
    }
  }
  return out;
}

}  // namespace lodestone::chain
