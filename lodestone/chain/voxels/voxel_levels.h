// Surfaces of one model at any resolution, all from one solid voxelization ([voxel-lod] in docs/papers/README.md).
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/chain/voxels/solid.h"
#include "lodestone/core/model.h"
#include "lodestone/spatial/bvh.h"
#include "lodestone/voxel/voxelize.h"

namespace lodestone::chain {

/// Where vertices lie.
enum class VertexPlacement {
  edge_ratio,  ///< at the step of a march along the edge at which the solid changes: the paper's
  linear,      ///< where shares of voxels, linear along the edge, reach a half
  project,     ///< there, then moved to the closest point of the model, at most a voxel
  sharp,       ///< one in each cut cube, on the model, and on its edges and corners where they run through
};

struct VoxelOptions {
  std::optional<voxel::FillRule> fill;  ///< without: by the input, see fill_for()
  double close = 0;                     ///< shrinkwrap: holes up to twice this radius are closed, model units
  /// Voxels of the solid in one of the finest level, along each side (the paper's downsampling ratio; it finds 5 to 15
  /// best; after projection more than 4 buy little). 0: 4, or 2 with winding and shrinkwrap, which take their time.
  std::uint32_t supersample = 0;
  VertexPlacement placement = VertexPlacement::project;
  bool keep_thin = false;  ///< what is thinner than a voxel of the level stays, at least that thick before projection
  /// Triangles are merged where the surface is flat, as far as it moves by about this share of a voxel; 0 = not. Even
  /// cells take as many in flat parts as in curved ones ([voxel-lod], section 3.5.2): this takes fewer there, without a
  /// crack, as edges are collapsed.
  double adaptive = 0;
  bool keep_volume = false;  ///< linear only: each level's iso is chosen so that it encloses the solid's volume
};

struct VoxelSeconds {
  double prepare = 0;  ///< what the rule needs to know, the scene in world space, its tree
  double voxelize = 0, resample = 0, isosurface = 0, measure = 0, collapse = 0;
};

/// One solid and the tree of its source.
class VoxelLevels {
 public:
  /// A solid for levels of up to `finest` voxels along the longest side. Errors: bad_argument (options out of range, a
  /// resolution that needs more than 65,535 voxels a side; those of validate()), empty, out_of_memory, cancelled.
  static Result<VoxelLevels> create(const Model& model, const VoxelOptions& options, std::uint32_t finest,
                                    Task task = {});

  /// For a solid that is there already, and the surface that vertices are moved to. Errors: bad_argument (those of
  /// validate(), of both), cancelled.
  static Result<VoxelLevels> of_solid(Solid solid, const FillChoice& fill, const VoxelOptions& options, Task task = {});

  /// The surface with so many voxels along the longest side, their margin of one at both ends counted; 4 to the
  /// solid's. Errors: bad_argument, empty (no part is half as thick as a voxel), unsupported, cancelled.
  Result<Mesh> surface_at(std::uint32_t resolution, Task task = {});

  const Solid& solid() const { return *solid_; }
  const FillChoice& fill() const { return fill_; }
  const VoxelSeconds& seconds() const { return seconds_; }
  std::uint32_t most_resolution() const;
  /// True for grids whose solid would not fit: each surface then voxelizes by itself.
  bool by_slabs() const { return slabs_; }
  std::uint64_t voxels_inside() const { return voxels_inside_; }
  /// Pieces of the model of which the surface at a resolution has nothing within a voxel, by name where they have one.
  std::vector<std::string> vanished(const Model& model, const Mesh& surface, std::uint32_t resolution) const;

 private:
  static Result<VoxelLevels> of_valid(Solid solid, const FillChoice& fill, const VoxelOptions& options,
                                      const Task& task);
  static Result<VoxelLevels> of_grid(const Model& model, const VoxelGrid& grid, const FillChoice& fill,
                                     const VoxelOptions& options, const Task& task);
  Result<Mesh> even_surface_at(std::uint32_t resolution, const Task& task);
  Result<Mesh> surface_by_slabs(std::uint32_t resolution, const Task& task);
  std::array<std::uint32_t, 3> size_at(std::uint32_t resolution) const;
  VoxelOptions options_;
  FillChoice fill_;
  std::unique_ptr<Solid> solid_;
  std::unique_ptr<spatial::Bvh> source_;  // of solid_->surface
  std::uint64_t voxels_inside_ = 0;
  bool slabs_ = false;  // no solid is kept: each surface makes its own, slab by slab
  VoxelSeconds seconds_;
};

}  // namespace lodestone::chain
