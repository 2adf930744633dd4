// The options of `lod render` and their values.
#pragma once

#include <optional>
#include <string>

#include "app/options/command_line.h"
#include "app/options/spec.h"
#include "lodestone/base/result.h"
#include "lodestone/math/camera.h"
#include "lodestone/render/render.h"

namespace lodestone::app {

OptionGroup camera_group();   ///< --view, --angles, --eye, --target, --up, --fov, --ortho
OptionGroup look_group();     ///< --shading, --wireframe, --background, --attribute, --range, --level
OptionGroup picture_group();  ///< -o, --size, --samples, --json

/// Where to look from, before the model is known.
struct CameraChoice {
  ViewAngles angles;
  std::optional<Vec3d> eye, target;
  Vec3d up{0, 1, 0};
  Lens lens;

  /// Frames the scene, or stands at `eye` and looks at `target` (without: the middle of its bounds).
  Camera camera(const render::Scene& scene, double aspect) const;
};

/// Errors: bad_argument.
Result<CameraChoice> camera_choice(const Arguments& arguments);

/// All but the shading, which may depend on the model. Errors: bad_argument.
Result<render::RenderOptions> render_options(const Arguments& arguments);

/// The shading by its name on the command line, and back.
std::optional<render::Shading> shading_of(const std::string& name);
const char* name_of(render::Shading shading);

}  // namespace lodestone::app
