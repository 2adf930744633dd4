// Levels straight from a solid's bits, as [voxel-lod] makes them.
#pragma once

#include <array>
#include <cstdint>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/mesh.h"
#include "lodestone/core/volume.h"

namespace lodestone::voxel {

struct EdgeRatioOptions {
  double threshold = 0.5;  ///< what VoxExt is above is inside; in (0, 1)
  /// Steps along each edge; 0 = the ratio of small voxels to a large one along it, as in the paper.
  std::uint32_t steps = 0;
  /// Whether a vertex lies half way between the step before the change and the one after. The paper takes the one
  /// after, which moves the surface by half a step towards the far ends of edges.
  bool between_steps = true;
  /// Samples begin at the first voxel's centre, as in the paper, so that they stop short of the far sides; else they
  /// are the middles of large voxels, which lie like those of downsample().
  bool from_first = false;
};

/// The surface by cubes between `samples` points a side, the middles of so many large voxels in the solid, each inside
/// where VoxExt says so ([voxel-lod], section 2.4.2), with vertices where a march along the edge finds the change
/// (EdgeRatio, section 2.4.4). Each crossed edge is marched once, where the paper marches it for every cube beside it.
/// Closed and manifold, as voxel::isosurface. O(samples + crossed edges · steps). Errors: bad_argument (no samples, or
/// more than voxels; a threshold outside of (0, 1); those of validate()), empty, unsupported, cancelled.
Result<Mesh> edge_ratio_surface(const BitVolume& solid, const std::array<std::uint32_t, 3>& samples,
                                const EdgeRatioOptions& options = {}, Task task = {});

}  // namespace lodestone::voxel
