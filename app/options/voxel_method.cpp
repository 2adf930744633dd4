#include "app/options/voxel_method.h"

#include <fmt/format.h>

#include "app/options/voxel_options.h"

namespace lodestone::app {

OptionGroup voxel_method_group() {
  OptionGroup group{
      "Levels by voxels",
      {{"--method",
        "",
        "M",
        "edge-collapse",
        "",
        "edge-collapse, or voxel: each level is a new closed surface made from voxels, whatever the input",
        {"edge-collapse", "voxel"},
        Completion::choices},
       {"--resolution",
        "",
        "N",
        "",
        "voxels",
        "with --then-collapse: resolution of the surface that is collapsed, along its longest side (without: chosen "
        "for the first level)",
        {},
        Completion::none}}};
  for (const OptionSpec& option : solid_group().options) {
    if (option.name != "--close") group.options.push_back(option);
  }
  for (const OptionSpec& option : level_group().options) group.options.push_back(option);
  for (const OptionSpec& option : baked_group().options) group.options.push_back(option);
  return group;
}

Result<std::optional<chain::VoxelLadderOptions>> voxel_method(const Arguments& arguments) {
  const bool voxel = arguments.text("--method") == "voxel";
  if (!voxel) {
    for (const OptionSpec& option : voxel_method_group().options) {
      if (option.name == "--method" || !arguments.has(option.name)) continue;
      return fail(ErrorCode::bad_argument, fmt::format("{} is for --method voxel", option.name), {},
                  "add --method voxel");
    }
    return std::optional<chain::VoxelLadderOptions>();
  }
  chain::VoxelLadderOptions method;
  method.then_collapse = arguments.has("--then-collapse");
  if (arguments.has("--resolution")) {
    if (!method.then_collapse) {
      return fail(ErrorCode::bad_argument, "--resolution is for --then-collapse: levels take theirs from the targets");
    }
    const Result<std::uint32_t> resolution = resolution_of(arguments);
    LODESTONE_TRY(resolution);
    method.resolution = *resolution;
  }
  const Result<chain::VoxelOptions> options = voxel_options(arguments, {}, {});
  LODESTONE_TRY(options);
  method.voxel = *options;
  Result<chain::SurfaceAttributeOptions> attributes = surface_attributes(arguments);
  LODESTONE_TRY(attributes);
  method.attributes = std::move(*attributes);
  return std::optional<chain::VoxelLadderOptions>(method);
}

}  // namespace lodestone::app
