#include "app/options/voxel_options.h"

#include <utility>

namespace lodestone::app {

OptionGroup resolution_group() {
  return {"Voxels",
          {{"--resolution",
            "",
            "N",
            "128",
            "voxels",
            "resolution along the longest side, with a margin of one voxel (4 to 16,384)",
            {},
            Completion::none}}};
}

OptionGroup solid_group() {
  return {"Solid",
          {{"--fill",
            "",
            "RULE",
            "",
            "",
            "what is inside: parity (an odd number of faces before it), nonzero (overlapping closed pieces are one), "
            "winding (open surfaces, their holes closed) or shrinkwrap (what can't be reached from outside once the "
            "surface is grown by --close); without: by the input",
            {"parity", "nonzero", "winding", "shrinkwrap"},
            Completion::choices},
           {"--close",
            "",
            "R",
            "",
            "length: 1% of the diagonal, or 2mm",
            "with shrinkwrap, and for scans: holes up to twice this radius are closed (without: two voxels, or by the "
            "scan)",
            {},
            Completion::none}}};
}

OptionGroup level_group() {
  return {
      "Surface by voxels",
      {{"--supersample",
        "",
        "K",
        "",
        "voxels",
        "how many times finer the solid is than the result, along each side (1 to 64; without: 4, or 2 with winding)",
        {},
        Completion::none},
       {"--place",
        "",
        "HOW",
        "project",
        "",
        "where vertices lie: project (on the input), sharp (on the input, and on its edges and corners), linear "
        "(interpolated between voxels) or edge-ratio (where a search along the voxels' edges meets the solid)",
        {"project", "sharp", "linear", "edge-ratio"},
        Completion::choices},
       {"--adaptive",
        "",
        "T",
        "",
        "voxels",
        "merge triangles where the surface is flat, moving it by at most about this share of a voxel (0.1)",
        {},
        Completion::none},
       {"--keep-thin", "", "", "", "", "keep what is thinner than a voxel", {}, Completion::none},
       {"--keep-volume", "", "", "", "", "with --place linear: keep the solid's volume", {}, Completion::none},
       {"--then-collapse",
        "",
        "",
        "",
        "",
        "make a finer surface and reach the target by edge collapse: far better triangles for the count",
        {},
        Completion::none}}};
}

OptionGroup remesh_target_group() {
  OptionGroup group = resolution_group();
  group.title = "Target (one of these; --then-collapse takes --resolution and another)";
  group.options.push_back({"--triangles", "", "N", "", "triangles", "at most this count", {}, Completion::none});
  group.options.push_back({"--error",
                           "",
                           "E",
                           "",
                           "length: 0.1% or 0.001 of the diagonal, or 2mm",
                           "the coarsest surface whose measured error is within it",
                           {},
                           Completion::none});
  group.options.push_back(
      {"--prune",
       "",
       "",
       "",
       "",
       "with --then-collapse: let separate parts vanish where that adds no larger error than the surface has",
       {},
       Completion::none});
  return group;
}

Result<std::uint32_t> resolution_of(const Arguments& arguments) {
  const Result<std::uint64_t> resolution = arguments.count("--resolution", 4, 16'384);
  LODESTONE_TRY(resolution);
  return static_cast<std::uint32_t>(*resolution);
}

namespace {
constexpr std::pair<const char*, voxel::FillRule> kFills[] = {{"parity", voxel::FillRule::parity},
                                                              {"nonzero", voxel::FillRule::nonzero},
                                                              {"winding", voxel::FillRule::winding},
                                                              {"shrinkwrap", voxel::FillRule::shrinkwrap}};
constexpr std::pair<const char*, chain::VertexPlacement> kPlacements[] = {
    {"edge-ratio", chain::VertexPlacement::edge_ratio},
    {"linear", chain::VertexPlacement::linear},
    {"project", chain::VertexPlacement::project},
    {"sharp", chain::VertexPlacement::sharp}};
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

Result<double> close_of(const Arguments& arguments, const LengthRules& lengths, const Model& model, double diagonal) {
  if (!arguments.has("--close")) return 0.0;
  const Result<std::vector<LengthArgument>> radius = length_list(arguments, "--close", lengths);
  LODESTONE_TRY(radius);
  if (radius->size() != 1) {
    return fail(ErrorCode::bad_argument, "--close takes one radius", {}, "such as --close 1%");
  }
  const Result<std::vector<double>> units = to_model_units(*radius, model, diagonal);
  LODESTONE_TRY(units);
  return units->front();
}

Result<chain::VoxelOptions> voxel_options(const Arguments& arguments, const LengthRules& lengths, const Model& model) {
  chain::VoxelOptions options;
  options.fill = fill_of(arguments);
  const Result<double> close = close_of(arguments, lengths, model, bounds_of(model).diagonal());
  LODESTONE_TRY(close);
  options.close = *close;
  if (options.close > 0 && !options.fill) options.fill = voxel::FillRule::shrinkwrap;
  if (options.close > 0 && options.fill != voxel::FillRule::shrinkwrap) {
    return fail(ErrorCode::bad_argument, "--close is for --fill shrinkwrap", {}, "leave one of them out");
  }
  if (arguments.has("--supersample")) {
    const Result<std::uint64_t> supersample = arguments.count("--supersample", 1, 64);
    LODESTONE_TRY(supersample);
    options.supersample = static_cast<std::uint32_t>(*supersample);
  }
  for (const auto& [name, placement] : kPlacements) {
    if (arguments.text("--place") == name) options.placement = placement;
  }
  if (arguments.has("--adaptive")) {
    const Result<double> adaptive = arguments.positive("--adaptive");
    LODESTONE_TRY(adaptive);
    options.adaptive = *adaptive;
  }
  options.keep_thin = arguments.has("--keep-thin");
  options.keep_volume = arguments.has("--keep-volume");
  if (options.keep_volume && options.placement != chain::VertexPlacement::linear) {
    return fail(ErrorCode::bad_argument, "--keep-volume is for --place linear: vertices on the input keep it anyway");
  }
  return options;
}

}  // namespace lodestone::app
