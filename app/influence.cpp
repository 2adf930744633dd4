#include "app/influence.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "lodestone/base/file.h"

namespace lodestone::app {
namespace {

constexpr const char* kFileRemedy = "a line is X Y Z RADIUS WEIGHT, or X Y Z RADIUS lock";

bool read_number(std::string_view text, double& out) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
  return error == std::errc{} && end == text.data() + text.size() && std::isfinite(out);
}

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::size_t at = 0; at < line.size();) {
    const std::size_t begin = line.find_first_not_of(" \t\r", at);
    if (begin == std::string_view::npos) break;
    const std::size_t end = std::min(line.find_first_of(" \t\r", begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    at = end;
  }
  return words;
}

// The centre and radius from the first four words.
bool read_sphere(const std::vector<std::string_view>& words, chain::InfluenceSphere& out) {
  return words.size() >= 4 && read_number(words[0], out.center.x) && read_number(words[1], out.center.y) &&
         read_number(words[2], out.center.z) && read_number(words[3], out.radius) && out.radius > 0;
}

Result<void> read_weights(const std::filesystem::path& path, std::vector<chain::InfluenceSphere>& spheres) {
  const Result<std::string> text = read_file(path);
  if (!text) return fail(text.error());
  std::size_t number = 0;
  for (std::size_t at = 0; at < text->size();) {
    const std::size_t end = std::min(text->find('\n', at), text->size());
    const std::string_view line = std::string_view(*text).substr(at, end - at);
    at = end + 1;
    ++number;
    const std::vector<std::string_view> words = words_of(line);
    if (words.empty() || words[0].starts_with('#')) continue;
    chain::InfluenceSphere sphere;
    sphere.locked = words.size() == 5 && words[4] == "lock";
    const bool good = words.size() == 5 && read_sphere(words, sphere) &&
                      (sphere.locked || (read_number(words[4], sphere.weight) && sphere.weight >= 0));
    if (!good) {
      return fail(ErrorCode::bad_format, fmt::format("'{}' is no sphere", line.substr(0, 60)),
                  fmt::format("{}: line {}", path.string(), number), kFileRemedy);
    }
    spheres.push_back(sphere);
  }
  return {};
}

Result<void> read_lock(const std::string& text, std::vector<chain::InfluenceSphere>& spheres) {
  const std::vector<std::string> parts = split_commas(text);
  chain::InfluenceSphere sphere;
  sphere.locked = true;
  if (parts.size() != 4 || !read_sphere({parts.begin(), parts.end()}, sphere)) {
    return fail(ErrorCode::bad_argument, fmt::format("--lock {} is no sphere", text), {},
                "four numbers, X,Y,Z,RADIUS, the radius above 0; several spheres go into a file for --weights");
  }
  spheres.push_back(sphere);
  return {};
}

}  // namespace

OptionGroup method_group() {
  return {"Method",
          {{"--keep-border", "", "", "", "", "open borders stay exactly as they are", {}, Completion::none},
           {"--lock",
            "",
            "X,Y,Z,R",
            "",
            "model units",
            "vertices in this sphere stay where they are",
            {},
            Completion::none},
           {"--weld",
            "",
            "LENGTH",
            "",
            "model units",
            "coarser levels take vertices nearer than this as one (1mm and 0.01% work, too); equal ones are one anyway",
            {},
            Completion::none},
           {"--weight-by",
            "",
            "NAME",
            "",
            "",
            "attribute that says how much a vertex matters: 1 as usual, 10 keeps some 3 times finer detail",
            {},
            Completion::none},
           {"--weights",
            "",
            "FILE",
            "",
            "",
            "spheres that matter more: lines of X Y Z RADIUS WEIGHT (or lock)",
            {},
            Completion::file}}};
}

Result<InfluencePlan> influence_of(const Arguments& arguments, const LengthRules& lengths) {
  InfluencePlan plan;
  plan.influence.keep_border = arguments.has("--keep-border");
  plan.influence.weight_attribute = arguments.text("--weight-by");
  std::vector<chain::InfluenceSphere>& spheres = plan.influence.spheres;
  if (arguments.has("--lock")) {
    if (const Result<void> ok = read_lock(arguments.text("--lock"), spheres); !ok) return fail(ok.error());
  }
  if (arguments.has("--weights")) {
    if (const Result<void> ok = read_weights(arguments.text("--weights"), spheres); !ok) return fail(ok.error());
  }
  if (arguments.has("--weld")) {
    const Result<std::vector<LengthArgument>> weld = length_list(arguments, "--weld", lengths, BareLength::model_units);
    if (!weld) return fail(weld.error());
    if (weld->size() != 1) {
      return fail(ErrorCode::bad_argument, "--weld takes one length", {}, "such as --weld 1mm");
    }
    plan.weld = weld->front();
  }
  return plan;
}

Result<chain::Influence> InfluencePlan::for_model(const Model& model) const {
  chain::Influence out = influence;
  if (!weld) return out;
  const Result<std::vector<double>> tolerance = to_model_units({*weld}, model, bounds_of(model).diagonal());
  if (!tolerance) return fail(tolerance.error());
  out.weld_tolerance = tolerance->front();
  return out;
}

}  // namespace lodestone::app
