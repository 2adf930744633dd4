#include "app/options/axes.h"

#include <fmt/format.h>

#include "lodestone/base/file.h"

namespace lodestone::app {
namespace {

// z to y and y to -z: what a patient's axes need as well.
Mat4d z_to_y() {
  Mat4d m;
  m.m = {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1};
  return m;
}

}  // namespace

OptionGroup axes_group() {
  return {"Axes",
          {{"--up",
            "",
            "AXIS",
            "y",
            "",
            "which axis of PLY, OBJ, STL, OFF and points is up, so that glTF is upright",
            {"y", "z"},
            Completion::choices}}};
}

UpAxis up_axis(const Arguments& arguments) {
  const OptionSpec* option = find_option(*arguments.verb, "--up");
  const bool is_camera = option != nullptr && option->choices.empty();  // of render
  if (is_camera || !arguments.has("--up")) return UpAxis::unsaid;
  return arguments.text("--up") == "z" ? UpAxis::z : UpAxis::y;
}

Result<void> apply_up(Model& model, UpAxis up, const std::filesystem::path& path) {
  if (up == UpAxis::unsaid) return {};
  if (model.document || !model.gltf_axes.is_identity()) {
    return fail(ErrorCode::bad_argument, fmt::format("'{}' has a rule which way is up", extension_of(path)),
                path.string(), "leave out --up");
  }
  if (up == UpAxis::z) model.gltf_axes = z_to_y();
  return {};
}

}  // namespace lodestone::app
