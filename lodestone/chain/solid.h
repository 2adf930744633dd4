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
#include "lodestone/voxel/voxelize.h"

namespace lodestone::chain {

struct SolidOptions {
  std::uint32_t resolution = 128;  ///< voxels along the longest side, with `margin` empty ones at both ends
  std::uint32_t margin = 1;
  std::uint32_t multiple = 1;           ///< each side of the grid is a multiple of this many voxels
  std::optional<voxel::FillRule> fill;  ///< without: by the input, see Solid::fill_reason
};

struct Solid {
  BitVolume volume;
  voxel::FillRule fill = voxel::FillRule::parity;
  std::string fill_reason;            ///< what was seen in the input, in plain words
  std::vector<std::string> warnings;  ///< what had to be assumed
};

/// The rule for a surface of this connectivity: closed surfaces get parity; closed pieces that all face one way, of
/// which there are several, nonzero, as they may overlap.
voxel::FillRule fill_for(const Topology& topology);

/// Voxelizes the default scene: world space, all instances. Errors: empty (nothing drawn, no voxel inside),
/// bad_argument (as voxel::grid_around), cancelled.
Result<Solid> solid_of(const Model& model, const SolidOptions& options = {}, Task task = {});

}  // namespace lodestone::chain
