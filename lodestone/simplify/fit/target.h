// What levels are fitted to: the original, prepared once.
#pragma once

#include <span>
#include <vector>

#include "lodestone/base/task.h"
#include "lodestone/core/mesh.h"
#include "lodestone/spatial/bvh.h"
#include "lodestone/spatial/surface.h"

namespace lodestone::simplify {

/// A mesh's surface with its tree, and points on it at which errors of levels are judged: its vertices, and for fitting
/// also the centres of its triangles. A level fitted to vertices alone would fit these and nothing between.
class FitTarget {
 public:
  /// O(n log n). The mesh must outlive it. A mesh without triangles gives an empty target.
  explicit FitTarget(const Mesh& original, const Task& task = {}, bool centres = true);
  FitTarget(const FitTarget&) = delete;
  FitTarget& operator=(const FitTarget&) = delete;

  const Mesh& original() const { return *original_; }
  const spatial::Surface& surface() const { return surface_; }
  const spatial::Bvh& tree() const { return tree_; }
  std::span<const Vec3d> points() const { return points_; }
  bool has_centres() const { return points_.size() > surface_.positions.size(); }
  /// The share of the area that each point stands for; they sum to 1.
  std::span<const float> weights() const { return weights_; }

  /// The chart of a wedge of the original: wedges that triangles join have the same. Empty without attributes.
  std::span<const std::uint32_t> charts() const { return charts_; }

 private:
  void find_charts();

  const Mesh* original_;
  spatial::Surface surface_;
  spatial::Bvh tree_;
  std::vector<Vec3d> points_;
  std::vector<float> weights_;
  std::vector<std::uint32_t> charts_;
};

/// The triangles of a mesh in the order that suits a tree, in mesh space with the offset; `drawn` names the mesh's.
spatial::Surface surface_of(const Mesh& mesh, const Task& task);

}  // namespace lodestone::simplify
