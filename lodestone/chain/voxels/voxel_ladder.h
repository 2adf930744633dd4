// Ladders whose levels are new surfaces by way of voxels ([voxel-lod]).
#pragma once

#include <cstdint>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/chain/ladder/build_ladder.h"
#include "lodestone/chain/voxels/surface_attributes.h"
#include "lodestone/chain/voxels/voxel_levels.h"
#include "lodestone/core/model.h"

namespace lodestone::chain {

struct VoxelLadderOptions {
  VoxelOptions voxel;
  bool then_collapse = false;          ///< levels are collapsed from one surface by voxels
  std::uint32_t resolution = 0;        ///< of that surface, voxels along the longest side; 0 = by the first level
  SurfaceAttributeOptions attributes;  ///< what levels take from the original, whose textures must be decoded for it
};

/// build_ladder() with levels by voxels in place of edge collapse, all from one solid, the finest first. The original
/// must be one mesh placed once, so that levels fit it in one file. Errors: as build_ladder() and
/// VoxelLevels::create() and AttributeSource, bad_argument (an original of several meshes).
Result<LadderResult> build_voxel_ladder(Model original, const LadderOptions& options, const VoxelLadderOptions& voxels,
                                        Task task = {});

}  // namespace lodestone::chain
