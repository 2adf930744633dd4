// Scene: a model made ready for drawing once, to be drawn from many cameras.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/input.h"
#include "lodestone/core/model.h"
#include "lodestone/math/box.h"
#include "lodestone/math/camera.h"

namespace lodestone::render {

namespace detail {
struct SceneData;  // scene_detail.h
}

struct SceneOptions {
  /// Numbers for Shading::heat, a list for each mesh of the model: one value a wedge, or one a vertex. An empty list:
  /// that mesh has none.
  std::vector<std::vector<float>> values;
  /// Without `values`: the attribute stream that holds them ("_ERROR"); of several components the length is taken.
  std::string attribute;
  Input input = Input::unchecked;  ///< of the model
};

/// A model's default scene in world space: all instances, bind pose, mirrored ones with their faces outward, triangles
/// along a Hilbert curve. Corners without a usable normal get one from the faces around the vertex that meet at less
/// than 50 degrees. Keeps nothing of the model but its decoded textures (io::decode_base_colors(), to be called
/// before). Cheap to copy: copies share the data, which never change.
class Scene {
 public:
  /// Time O(n log n), memory 40 bytes a triangle and 24 a vertex, with textures, colours and values up to 100 a
  /// triangle. Errors: empty (no triangle drawn), bad_argument (values that don't fit the meshes, an attribute that
  /// none of them has; those of validate()), unsupported (more than 1.4 billion triangles), cancelled.
  static Result<Scene> create(const Model& model, const SceneOptions& options = {}, Task task = {});

  /// Of all finite positions drawn, world space.
  const Box3d& bounds() const;
  std::size_t triangle_count() const;
  bool has_textures() const;  ///< some material drawn has a base colour texture (be it missing)
  bool has_colors() const;    ///< some mesh drawn has vertex colours
  bool has_values() const;
  /// Smallest and largest finite heat value; 0 and 0 without any.
  double least_value() const;
  double largest_value() const;
  /// The instance that draws a triangle; triangles are numbered over all instances, as Frame::triangle does.
  std::uint32_t instance_of(std::uint32_t drawn_triangle) const;
  /// A camera that sees all of it, as near as can be: frame_points() of its vertices. O(vertices).
  Camera framed(const ViewAngles& angles, double aspect, const Lens& lens = {}, Vec3d up = {0, 1, 0}) const;
  /// What can't be drawn as the model means it (textures that are missing or have no UVs), for the user.
  const std::vector<std::string>& notes() const;

  const detail::SceneData& data() const { return *data_; }

 private:
  std::shared_ptr<const detail::SceneData> data_;
};

}  // namespace lodestone::render
