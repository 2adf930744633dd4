// Levels from one solid voxelization (paper 000): whatever the input, closed manifold surfaces.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/chain/solid.h"
#include "lodestone/core/level.h"
#include "lodestone/measure/distance.h"
#include "lodestone/voxel/voxelize.h"

namespace lodestone::chain {

struct RemeshOptions {
  /// Voxels along the longest side of each level, the margin of one at both ends counted; falling, the finest first.
  std::vector<std::uint32_t> resolutions{128};
  /// Voxels of the solid in one of the finest level, along each side (the paper's downsampling ratio; it finds 5 to 15
  /// best; after projection more than 4 buy little). 0: 4, or 2 where winding numbers fill, as they take their time.
  std::uint32_t supersample = 0;
  std::optional<voxel::FillRule> fill;  ///< without: by the input, see fill_for()
  bool project = true;                  ///< move vertices onto the source, at most a voxel of the level far
  bool measure = true;
  measure::DistanceOptions distance;
};

struct RemeshSeconds {
  double prepare = 0;  ///< what the rule needs to know, the scene in world space, its tree
  double voxelize = 0, resample = 0, isosurface = 0, measure = 0;
};

struct RemeshResult {
  std::vector<Level> levels;                  ///< one a resolution; method "voxels"
  std::array<std::uint32_t, 3> resolution{};  ///< of the solid
  std::uint64_t voxels_inside = 0;
  FillChoice fill;
  std::vector<std::string> warnings;
  RemeshSeconds seconds;
};

/// Voxelizes the model's default scene once and contours it at each resolution: shares of set voxels, Marching Cubes at
/// a half, vertices moved onto the source. Errors: bad_argument (resolutions that don't fall, or that need more than
/// 65,535 voxels a side), empty, cancelled.
Result<RemeshResult> remesh(const Model& model, const RemeshOptions& options = {}, Task task = {});

}  // namespace lodestone::chain
