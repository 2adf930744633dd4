// What the tests of the renderer share: flat shapes before a camera whose pixels are known.
#pragma once

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>
#include <vector>

#include "lodestone/render/render.h"
#include "support/shapes.h"

namespace lodestone::test {

/// Looks along -z at the square from (0, 0) to (side, side), one unit a pixel, the y axis up.
inline Camera flat_camera(double side) {
  Camera camera = look_at({side / 2, side / 2, side}, {side / 2, side / 2, 0});
  camera.orthographic = true;
  camera.half_height = side / 2;
  return camera;
}

inline render::Scene scene_of(const Model& model, const render::SceneOptions& options = {}) {
  Result<render::Scene> scene = render::Scene::create(model, options);
  return std::move(scene.value());
}
inline render::Scene scene_of(Mesh mesh) { return scene_of(make_model(std::move(mesh))); }

inline render::Frame frame_of(const render::Scene& scene, const Camera& camera, std::uint32_t side, int samples = 4) {
  return std::move(render::rasterize(scene, camera, side, side, samples).value());
}

/// Samples that see something.
inline std::size_t samples_of(const render::Frame& frame) {
  return std::accumulate(frame.coverage.begin(), frame.coverage.end(), std::size_t{0});
}

/// A square from (0, 0) to (side, side) in the plane z = 0 that looks to +z.
inline Mesh square(float side) {
  return make_mesh({{0, 0, 0}, {side, 0, 0}, {side, side, 0}, {0, side, 0}}, {{0, 1, 2}, {0, 2, 3}});
}

inline render::RenderOptions picture_of(std::uint32_t side, render::Shading shading) {
  render::RenderOptions options;
  options.width = options.height = side;
  options.shading = shading;
  return options;
}

inline Pixels drawn(const render::Scene& scene, const Camera& camera, const render::RenderOptions& options) {
  return std::move(render::render(scene, camera, options).value());
}

/// Clearly more of channel `k` than of the two others.
inline bool is_mostly(const std::array<std::uint8_t, 4>& pixel, std::size_t k) {
  return pixel[k] > 2 * std::max(pixel[(k + 1) % 3], pixel[(k + 2) % 3]);
}

}  // namespace lodestone::test
