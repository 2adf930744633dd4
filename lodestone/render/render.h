// Pictures of models, drawn by the processor alone: the same bytes on every machine, for any number of threads.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/model.h"
#include "lodestone/core/pixels.h"
#include "lodestone/math/camera.h"
#include "lodestone/render/frame.h"
#include "lodestone/render/scene.h"

namespace lodestone::render {

enum class Shading {
  smooth,        ///< grey, by the corners' normals
  flat,          ///< grey, by the faces' normals
  textured,      ///< base colour factor x texture x vertex colour, lit
  vertex_color,  ///< vertex colours alone, lit
  normals,       ///< the corners' normals as colours: x, y, z from -1 to 1 as red, green, blue
  face_normals,  ///< the faces' normals as colours
  heat,          ///< the scene's values as colours, with a legend
};

/// The values at the two ends of the heat map's colours; what is beyond gets the end's colour.
struct HeatRange {
  double least = 0, largest = 1;
};

struct RenderOptions {
  std::uint32_t width = 1280, height = 720;  ///< pixels, 1 to kMostSide
  Shading shading = Shading::smooth;
  bool wireframe = false;  ///< the visible triangles' sides on top, fainter where they are smaller than a few pixels
  int samples = 4;         ///< of each pixel: 4 smooths edges, 1 does not
  std::array<std::uint8_t, 4> background{236, 238, 241, 255};  ///< sRGB and alpha
  std::optional<HeatRange>
      heat_range;      ///< without: from the scene's least value (or 0, if that is near) to its largest
  bool legend = true;  ///< heat only
  std::string unit;    ///< of the values, for the legend: "mm"
};

/// A picture: sRGB, alpha not multiplied in. Light from beside the eye and a soft sky; matte surfaces. Faces seen from
/// behind are drawn lit and, unless their material is double-sided, in a dull blue, so that holes and turned faces
/// show. Materials' alpha counts where it is a mask, all else is opaque. O(triangles + pixels); some 40 bytes a
/// triangle on top of the scene. Errors: bad_argument (as rasterize(); heat without values), cancelled.
Result<Pixels> render(const Scene& scene, const Camera& camera, const RenderOptions& options = {}, Task task = {});

/// The same from a model drawn once. Errors: those of Scene::create too.
Result<Pixels> render(const Model& model, const Camera& camera, const RenderOptions& options = {}, Task task = {});

/// Textured if something drawn has a texture, else by vertex colour if something has, else smooth.
Shading default_shading(const Scene& scene);

/// What an unset RenderOptions::heat_range means.
HeatRange default_heat_range(const Scene& scene);

}  // namespace lodestone::render
