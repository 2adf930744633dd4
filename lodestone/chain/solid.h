// A model as a solid of voxels, with the rule that suits it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/model.h"
#include "lodestone/core/topology.h"
#include "lodestone/spatial/surface.h"
#include "lodestone/voxel/voxelize.h"

namespace lodestone::chain {

/// The rule that fills a model, and why.
struct FillChoice {
  voxel::FillRule fill = voxel::FillRule::parity;
  std::string reason;  ///< what was seen in the model, in plain words: "223 edges are open"
  bool closed = true;  ///< no edge is open
  bool asked = false;  ///< it was asked for by name
};

/// The rule for a surface of this connectivity: closed surfaces get parity; closed pieces that all face one way, of
/// which there are several, nonzero, as they may overlap; open ones winding.
voxel::FillRule fill_for(const Topology& topology);

/// For what the default scene draws; `asked` rules where there is one. O(n log n). Errors: bad_argument (parity asked
/// for an open surface), cancelled.
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
/// bad_argument (as voxel::grid_around), cancelled.
Result<Solid> solid_of(const Model& model, const FillChoice& choice, const SolidOptions& options = {}, Task task = {});

}  // namespace lodestone::chain
