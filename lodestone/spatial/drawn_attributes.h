// What a model's surface carries at a point, as a viewer would draw it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "lodestone/core/model.h"
#include "lodestone/spatial/surface.h"

namespace lodestone::spatial {

/// A point of a surface: a triangle and its corners' weights.
struct SurfacePoint {
  std::uint32_t triangle = 0;
  double second = 0, third = 0;  ///< weights of the second and the third corner

  std::array<double, 3> weights() const { return {1 - second - third, second, third}; }
};

/// Reads attributes at places of a flattened model, interpolated within the triangle. A value is nothing where the
/// primitive does not have the stream or one of the corners' numbers is not finite. Model and surface must outlive it.
class DrawnAttributes {
 public:
  DrawnAttributes(const Model& model, const spatial::Surface& surface);

  bool has_normals() const { return has_normals_; }
  bool has_color() const { return has_color_; }
  /// Whether anything but plain white is drawn: textures, base colours, vertex colours.
  bool has_appearance() const { return has_appearance_; }
  /// Numbers of the UV sets that anything drawn has, rising.
  const std::vector<std::uint32_t>& uv_sets() const { return uv_sets_; }

  /// Unit, world space: the normal stream's; the face's where there is none. Nothing for a triangle without area.
  std::optional<Vec3d> normal(const SurfacePoint& place) const;
  /// The normal stream's alone; nothing where there is none.
  std::optional<Vec3d> stream_normal(const SurfacePoint& place) const;
  /// The origin at the image's top, whatever the model's convention. Without texture transforms.
  std::optional<Vec2d> uv(const SurfacePoint& place, std::uint32_t set) const;
  /// RGB of COLOR_0, each cut to [0, 1].
  std::optional<Vec3d> color(const SurfacePoint& place) const;
  /// Base colour factor x texture x vertex colour as light, [0, 1]. A texture that is missing counts as white.
  Vec3d light(const SurfacePoint& place) const;

  /// Diagonal of the box of all UVs drawn in this set; 0 without any.
  double uv_diagonal(std::uint32_t set) const;

 private:
  struct Streams {
    const AttributeStream *normal = nullptr, *color = nullptr;
    std::vector<const AttributeStream*> uv;  // by set; null = none
  };
  struct DrawnTriangle {
    const Mesh* mesh;
    const Streams* streams;
    std::uint32_t instance, group;
    Triangle wedges;  // in the order of the surface's corners
  };
  DrawnTriangle drawn_triangle(std::uint32_t triangle) const;
  void note_sets();
  std::optional<Vec2d> uv_at(const DrawnTriangle& spot, const SurfacePoint& place, std::uint32_t set) const;
  std::optional<Vec3d> color_at(const DrawnTriangle& spot, const SurfacePoint& place) const;

  const Model& model_;
  const spatial::Surface& surface_;
  std::vector<std::uint32_t> first_;           // of each instance, its first drawn triangle; and the end
  std::vector<Streams> streams_;               // of each mesh
  std::vector<Mat4d> to_local_;                // of each instance, the inverse of its transform's linear part
  std::vector<std::uint8_t> mirrored_, flat_;  // of each instance: turned inside out; squeezed to a plane or less
  std::vector<std::uint32_t> uv_sets_;
  bool has_normals_ = false, has_color_ = false, has_appearance_ = false;
};

}  // namespace lodestone::spatial
