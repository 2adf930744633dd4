#include "app/options/attributes.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "app/output/text.h"
#include "lodestone/base/units.h"
#include "lodestone/core/skin.h"

namespace lodestone::app {
namespace {

// One word of --attribute-weights: NAME=W.
bool read_weight(const std::string& word, simplify::AttributeWeights& weights) {
  const std::size_t equals = word.rfind('=');
  if (equals == std::string::npos || equals == 0) return false;
  float weight = 0;
  const char* end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data() + equals + 1, end, weight);
  if (error != std::errc{} || stop != end || !(weight >= 0 && weight <= 1e6F)) return false;
  const std::string name = word.substr(0, equals);
  const std::pair<const char*, float*> kinds[] = {{"normal", &weights.normal},
                                                  {"uv", &weights.uv},
                                                  {"color", &weights.color},
                                                  {"morph", &weights.morph},
                                                  {"generic", &weights.generic}};
  for (const auto& [kind, into] : kinds) {
    if (name != kind) continue;
    *into = weight;
    return true;
  }
  weights.by_name.emplace_back(name, weight);
  return true;
}

}  // namespace

OptionGroup level_attributes_group() {
  return {"Attributes",
          {{"--attribute-weights",
            "",
            "NAME=W,...",
            "",
            "",
            "how much errors of attributes count, as a multiple of the default: normal, uv, color, morph, generic, or "
            "a stream's name such as COLOR_1; 0 = not at all",
            {},
            Completion::none},
           {"--influences",
            "",
            "N",
            "4",
            "joints",
            "most skin joints that a vertex of a coarser level keeps, those of the largest weights; 0 = all",
            {},
            Completion::none},
           {"--tangents",
            "",
            "HOW",
            "keep",
            "",
            "tangents of coarser levels. keep: the original's, which normal maps were made for; rebuild: computed from "
            "normals and UVs; drop: none",
            {"keep", "rebuild", "drop"},
            Completion::choices}}};
}

Result<void> read_attribute_options(const Arguments& arguments, chain::SimplifyConstraints& constraints) {
  if (arguments.has("--attribute-weights")) {
    for (const std::string& word : split_commas(arguments.text("--attribute-weights"))) {
      if (read_weight(word, constraints.attribute_weights)) continue;
      return fail(ErrorCode::bad_argument, fmt::format("--attribute-weights: '{}' is no weight", printable(word)), {},
                  "write NAME=W, W from 0 to 1000000, such as uv=2,color=0.5");
    }
  }
  const Result<std::uint64_t> influences = arguments.count("--influences");
  LODESTONE_TRY(influences);
  constraints.max_skin_influences = *influences;
  for (const char* option : {"--influences", "--tangents"}) {
    if (!arguments.has(option) || !arguments.has("--only")) continue;
    return fail(ErrorCode::bad_argument, fmt::format("{} does not go with --only", option), {},
                "leave one of them out: --only keeps all other triangles to the bit");
  }
  const std::string tangents = arguments.text("--tangents");
  if (tangents == "rebuild") constraints.tangents = chain::Tangents::rebuilt;
  if (tangents == "drop") constraints.tangents = chain::Tangents::dropped;
  return {};
}

void tell_of_attributes(const Model& model, const chain::SimplifyConstraints& constraints,
                        std::vector<std::string>& warnings) {
  std::size_t cut = 0;
  for (const Mesh& mesh : model.meshes) {
    cut += constraints.max_skin_influences > 0 && constraints.only.empty()
               ? wedges_above(mesh, constraints.max_skin_influences)
               : 0;
  }
  if (cut > 0) {
    warnings.push_back(
        fmt::format("on {} corners more joints pull than {}; coarser levels keep the heaviest "
                    "(--influences 0 keeps all)",
                    with_separators(cut), constraints.max_skin_influences));
  }
  for (const auto& weight : constraints.attribute_weights.by_name) {
    const std::string& name = weight.first;
    const bool known = std::any_of(model.meshes.begin(), model.meshes.end(), [&](const Mesh& mesh) {
      return std::any_of(mesh.attributes.begin(), mesh.attributes.end(),
                         [&](const AttributeStream& stream) { return stream.name == name; });
    });
    if (!known) warnings.push_back(fmt::format("--attribute-weights: the model has no attribute {}", printable(name)));
  }
}

}  // namespace lodestone::app
