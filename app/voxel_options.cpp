#include "app/voxel_options.h"

namespace lodestone::app {

OptionGroup voxel_group() {
  return {"Voxels",
          {{"--resolution",
            "",
            "N",
            "128",
            "voxels",
            "along the longest side, with a margin of one (4 to 16,384)",
            {},
            Completion::none},
           {"--fill",
            "",
            "RULE",
            "",
            "",
            "what is inside: parity (an odd number of faces before it) or nonzero (overlapping closed pieces are one); "
            "without: by the input",
            {"parity", "nonzero"},
            Completion::choices}}};
}

OptionGroup remesh_group() {
  OptionGroup group = voxel_group();
  group.options.push_back({"--supersample",
                           "",
                           "K",
                           "4",
                           "voxels",
                           "voxels of the solid in one of the result, along each side (1 to 64)",
                           {},
                           Completion::none});
  group.options.push_back({"--no-project",
                           "",
                           "",
                           "",
                           "",
                           "leave vertices where the voxels put them, not on the input's surface",
                           {},
                           Completion::none});
  return group;
}

Result<std::uint32_t> resolution_of(const Arguments& arguments) {
  const Result<std::uint64_t> resolution = arguments.count("--resolution", 4, 16'384);
  if (!resolution) return fail(resolution.error());
  return static_cast<std::uint32_t>(*resolution);
}

std::optional<voxel::FillRule> fill_of(const Arguments& arguments) {
  if (!arguments.has("--fill")) return std::nullopt;
  return arguments.text("--fill") == "nonzero" ? voxel::FillRule::nonzero : voxel::FillRule::parity;
}

std::string name_of(voxel::FillRule fill) { return fill == voxel::FillRule::nonzero ? "nonzero" : "parity"; }

}  // namespace lodestone::app
