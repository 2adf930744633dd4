#include "lodestone/chain/voxels/solid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lodestone/base/memory.h"
#include "lodestone/base/units.h"
#include "lodestone/core/validate.h"
#include "lodestone/measure/shape.h"

namespace lodestone::chain {

namespace {

std::string reason_of(const Topology& t) {
  if (t.boundary_edges > 0) return fmt::format("{} edges are open", with_separators(t.boundary_edges));
  if (!t.closed) return fmt::format("doubled faces hide {} open edges", with_separators(t.hidden_boundary_edges));
  return t.components > 1 ? fmt::format("{} closed pieces", with_separators(t.components)) : "closed";
}

// More voxels at the ends, the model in the middle, so that each side is a multiple.
void widen(VoxelGrid& grid, std::uint32_t multiple) {
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t more = (multiple - grid.size[k] % multiple) % multiple;
    grid.size[k] += more;
    grid.origin[k] -= grid.spacing[k] * more / 2;
  }
}

}  // namespace

voxel::FillRule fill_for(const Topology& t) {
  if (!t.closed) return voxel::FillRule::winding;
  const bool pieces = t.components > 1 && t.boundary_edges + t.inconsistent_edges + t.nonmanifold_edges == 0;
  return pieces ? voxel::FillRule::nonzero : voxel::FillRule::parity;
}

Result<FillChoice> choose_fill(const Model& model, std::optional<voxel::FillRule> asked, const Task& task) {
  const Result<measure::Shape> shape = measure::shape_of(model, task);
  LODESTONE_TRY(shape);
  const Topology& t = shape->topology;
  FillChoice out{asked.value_or(fill_for(t)), reason_of(t), t.closed, t.duplicate_faces > 0, asked.has_value()};
  if (out.closed || asked != voxel::FillRule::parity) return out;
  return fail(ErrorCode::bad_argument, fmt::format("parity needs a closed surface, but {}", out.reason), {},
              "use `fill` winding");
}

namespace {

// Shrinkwrap's radius in voxels.
double close_voxels(const FillChoice& choice, double voxel) {
  constexpr double kUsual = 2;
  return choice.close > 0 ? choice.close / voxel : kUsual;
}

std::string way_out_of_nothing(const FillChoice& choice) {
  if (!choice.closed) return "it is open and encloses nothing: close it first, or use `fill` shrinkwrap";
  const std::string thin = "its parts are thinner than a voxel: raise `resolution`";
  return choice.doubled ? thin + "; or its faces lie back to back: use `fill` shrinkwrap" : thin;
}

}  // namespace

Result<void> check_memory(const VoxelGrid& grid, double bytes_a_voxel) {
  const double needed = static_cast<double>(grid.count()) * bytes_a_voxel;
  const auto there = static_cast<double>(available_memory_bytes());
  if (needed <= 0.9 * there) return {};
  return fail(
      ErrorCode::out_of_memory,
      fmt::format("{} x {} x {} voxels need {}, {} are left", grid.size[0], grid.size[1], grid.size[2],
                  human_bytes(static_cast<std::uint64_t>(needed)), human_bytes(static_cast<std::uint64_t>(there))),
      {}, "lower `resolution` or `supersample`");
}

Result<VoxelGrid> solid_grid(const Box3d& bounds, const FillChoice& choice, const SolidOptions& options) {
  std::uint32_t margin = options.margin;
  if (choice.fill == voxel::FillRule::shrinkwrap) {
    // The growth needs room as well: the radius is told in voxels of a grid without it, or a little more.
    const Vec3d size = bounds.size();
    const double voxel = std::max({size.x, size.y, size.z}) / options.resolution;
    const double room = std::ceil(voxel > 0 ? close_voxels(choice, voxel) : 0) + 3;
    if (!(2 * room < options.resolution)) {
      return fail(ErrorCode::bad_argument, "the radius within which holes are to be closed is most of the model", {},
                  "lower `close`");
    }
    margin = std::max(margin, static_cast<std::uint32_t>(room));
  }
  Result<VoxelGrid> grid = voxel::grid_around(bounds, options.resolution, margin);
  if (!grid) return grid;
  widen(*grid, options.multiple);
  return grid;
}

Result<Solid> solid_of(const Model& model, const FillChoice& choice, const SolidOptions& options, Task task) {
  LODESTONE_TRY(validate(model, task));
  const Result<VoxelGrid> grid = solid_grid(bounds_of(model), choice, options);
  LODESTONE_TRY(grid);
  return solid_in(model, choice, *grid, task);
}

std::vector<std::string> assumptions(const FillChoice& choice, std::uint64_t leaking_columns) {
  std::vector<std::string> out;
  if (choice.fill == voxel::FillRule::winding && !choice.asked) {
    out.push_back(choice.reason + ": holes are closed by what seems most inside (winding numbers)");
  }
  if (leaking_columns > 0) {
    out.push_back(fmt::format("{} lines of voxels enter the model and never leave it, as {}",
                              with_separators(leaking_columns), choice.reason));
  }
  return out;
}

Result<Solid> solid_in(const Model& model, const FillChoice& choice, const VoxelGrid& grid, Task task) {
  const bool wraps = choice.fill == voxel::FillRule::shrinkwrap;
  LODESTONE_TRY(check_memory(grid, wraps ? 2.5 : 0.125));
  Result<spatial::Surface> surface = spatial::flatten(model, task.part(0.3));
  LODESTONE_TRY(surface);
  const voxel::VoxelizeOptions fill{choice.fill, close_voxels(choice, grid.spacing.x), Input::valid};
  Result<voxel::Voxelized> made = voxel::voxelize(*surface, grid, fill, task.part(0.7));
  LODESTONE_TRY(made);
  if (made->volume.set_count() == 0) {
    return fail(ErrorCode::empty, "no voxel lies inside the model", {}, way_out_of_nothing(choice));
  }
  Solid out;
  out.warnings = assumptions(choice, made->leaking_columns);
  out.volume = std::move(made->volume);
  out.surface = std::move(*surface);
  out.seconds = made->seconds;
  return out;
}

}  // namespace lodestone::chain
