#include "app/voxel_options.h"

#include <utility>

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
            "what is inside: parity (an odd number of faces before it), nonzero (overlapping closed pieces are one) or "
            "winding "
            "(open surfaces, their holes closed); without: by the input",
            {"parity", "nonzero", "winding"},
            Completion::choices}}};
}

OptionGroup remesh_group() {
  OptionGroup group = voxel_group();
  group.options.push_back(
      {"--supersample",
       "",
       "K",
       "",
       "voxels",
       "voxels of the solid in one of the result, along each side (1 to 64; without: 4, or 2 with winding)",
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

namespace {
constexpr std::pair<const char*, voxel::FillRule> kFills[] = {
    {"parity", voxel::FillRule::parity}, {"nonzero", voxel::FillRule::nonzero}, {"winding", voxel::FillRule::winding}};
}  // namespace

std::optional<voxel::FillRule> fill_of(const Arguments& arguments) {
  for (const auto& [name, fill] : kFills) {
    if (arguments.text("--fill") == name) return fill;
  }
  return std::nullopt;
}

std::string name_of(voxel::FillRule fill) {
  for (const auto& [name, known] : kFills) {
    if (fill == known) return name;
  }
  return "";
}

}  // namespace lodestone::app
