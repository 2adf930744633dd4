// Models as solids: which rule fills them, and their voxels.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/model.h"
#include "lodestone/core/topology.h"
#include "lodestone/core/volume.h"
#include "lodestone/spatial/surface.h"
#include "lodestone/voxel/voxelize.h"

namespace lodestone::chain {

/// The rule that fills a model, and why.
struct FillChoice {
  voxel::FillRule fill = voxel::FillRule::parity;
  std::string reason;    ///< what was seen in the model, in plain words: "223 edges are open"
  bool closed = true;    ///< no edge is open
  bool doubled = false;  ///< faces are listed twice
  bool asked = false;    ///< it was asked for by name
  double close = 0;      ///< shrinkwrap: the radius within which holes are closed, model units; 0 = two voxels
};

/// The rule for a surface of this connectivity: closed surfaces get parity; closed pieces that all face one way, of
/// which there are several, nonzero, as they may overlap; open ones winding.
voxel::FillRule fill_for(const Topology& topology);

/// For what the default scene draws; `asked` rules where there is one. O(n log n). Errors: bad_argument (parity asked
/// for an open surface; those of validate()), cancelled.
Result<FillChoice> choose_fill(const Model& model, std::optional<voxel::FillRule> asked, const Task& task = {});

struct SolidOptions {
  std::uint32_t resolution = 128;  ///< voxels along the longest side, with `margin` empty ones at both ends
  std::uint32_t margin = 1;
  std::uint32_t multiple = 1;  ///< each side of the grid is a multiple of this many voxels
};

struct Solid {
  BitVolume volume;
  spatial::Surface surface;           ///< what it was made from, in world space
  std::vector<std::string> warnings;  ///< what had to be assumed
  voxel::VoxelizeSeconds seconds;     ///< of voxelizing alone, without flattening the scene
};

/// Voxelizes the default scene: world space, all instances. Errors: empty (nothing drawn, no voxel inside),
/// bad_argument (as voxel::grid_around; those of validate()), out_of_memory (more than the machine has left: the line
/// says how much), cancelled.
Result<Solid> solid_of(const Model& model, const FillChoice& choice, const SolidOptions& options = {}, Task task = {});

/// The same in a given grid. Errors as above.
Result<Solid> solid_in(const Model& model, const FillChoice& choice, const VoxelGrid& grid, Task task = {});

/// The grid of solid_of() around a box. Errors: bad_argument.
Result<VoxelGrid> solid_grid(const Box3d& bounds, const FillChoice& choice, const SolidOptions& options);

/// What had to be assumed to fill a model, in plain words for the user.
std::vector<std::string> assumptions(const FillChoice& choice, std::uint64_t leaking_columns);

/// Whether so many bytes for a grid can be had. Errors: out_of_memory, which says how many are needed and there.
Result<void> check_memory(const VoxelGrid& grid, double bytes_a_voxel);

}  // namespace lodestone::chain
