// The source of attributes: a model whose normal and colour can be asked for near any point of space.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/model.h"
#include "lodestone/spatial/drawn_attributes.h"
#include "lodestone/spatial/surface.h"

namespace lodestone::bake {

/// A model made ready once: what it draws, in world space, and a tree over it. Textures are those that
/// io::decode_base_colors() put into Material::base_color_pixels; a material whose texture was not decoded has none.
/// Cheap to copy; many threads may ask at once. Memory: about 100 bytes a triangle, 36 more without a normal stream.
class BakeSource {
 public:
  /// The model must outlive the source. O(n log n). Errors: bad_argument (those of validate()), empty, unsupported,
  /// cancelled.
  static Result<BakeSource> create(const Model& model, Task task = {});

  /// For each point, world space, the place of the source that it takes its attributes from: the closest one. Where
  /// that faces away from the point's normal by more than a right angle, as at thin walls, the closest one that doesn't
  /// is preferred if it is at most a hundredth of the source's diagonal farther. Some thousands at a time serve best;
  /// the answers for a batch depend on the batch alone.
  void find(std::span<const Vec3d> points, std::span<const Vec3d> normals,
            std::span<spatial::SurfacePoint> places) const;

  /// Position of a place, world space.
  Vec3d point(const spatial::SurfacePoint& place) const;
  /// Unit shading normal, world space: the normal stream's, interpolated; without one a smooth normal that keeps edges
  /// sharper than 50 degrees. Zero on a triangle without area.
  Vec3d normal(const spatial::SurfacePoint& place) const;
  /// RGB as light, [0, 1]: base colour factor x texture x vertex colour. White where there is none of them.
  Vec3d color(const spatial::SurfacePoint& place) const;
  /// Whether color() is anything but white anywhere.
  bool has_color() const;

  const spatial::Surface& surface() const;

 private:
  struct Data;
  explicit BakeSource(std::shared_ptr<const Data> data) : data_(std::move(data)) {}
  std::shared_ptr<const Data> data_;
};

}  // namespace lodestone::bake
