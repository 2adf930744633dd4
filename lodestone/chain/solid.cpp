#include "lodestone/chain/solid.h"

#include <fmt/format.h>

#include "lodestone/base/units.h"
#include "lodestone/measure/shape.h"

namespace lodestone::chain {

namespace {

std::string reason_of(const Topology& t) {
  if (t.boundary_edges > 0) return fmt::format("{} edges are open", with_separators(t.boundary_edges));
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
  if (t.boundary_edges > 0) return voxel::FillRule::winding;
  const bool pieces = t.components > 1 && t.boundary_edges + t.inconsistent_edges + t.nonmanifold_edges == 0;
  return pieces ? voxel::FillRule::nonzero : voxel::FillRule::parity;
}

Result<FillChoice> choose_fill(const Model& model, std::optional<voxel::FillRule> asked, const Task& task) {
  const Result<measure::Shape> shape = measure::shape_of(model, task);
  if (!shape) return fail(shape.error());
  const Topology& t = shape->topology;
  FillChoice out{asked.value_or(fill_for(t)), reason_of(t), t.boundary_edges == 0, asked.has_value()};
  if (out.closed || asked != voxel::FillRule::parity) return out;
  return fail(ErrorCode::bad_argument, fmt::format("parity needs a closed surface, but {}", out.reason), {},
              "use --fill winding");
}

Result<Solid> solid_of(const Model& model, const FillChoice& choice, const SolidOptions& options, Task task) {
  Result<spatial::Surface> surface = spatial::flatten(model, task.part(0.3));
  if (!surface) return fail(surface.error());
  Result<VoxelGrid> grid = voxel::grid_around(surface->bounds, options.resolution, options.margin);
  if (!grid) return fail(grid.error());
  widen(*grid, options.multiple);
  Result<voxel::Voxelized> made = voxel::voxelize(*surface, *grid, {choice.fill}, task.part(0.7));
  if (!made) return fail(made.error());
  if (made->volume.set_count() == 0) {
    return fail(ErrorCode::empty, "no voxel lies inside the model", {},
                choice.closed ? "its parts are thinner than a voxel: raise --resolution"
                              : "it is open and encloses nothing: close it first");
  }
  Solid out;
  if (choice.fill == voxel::FillRule::winding && !choice.asked) {
    out.warnings.push_back(choice.reason + ": holes are closed by what seems most inside (winding numbers)");
  }
  if (made->leaking_columns > 0) {
    out.warnings.push_back(fmt::format("{} lines of voxels enter the model and never leave it, as {}",
                                       with_separators(made->leaking_columns), choice.reason));
  }
  out.volume = std::move(made->volume);
  out.surface = std::move(*surface);
  out.seconds = made->seconds;
  return out;
}

}  // namespace lodestone::chain
