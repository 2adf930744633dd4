#include "app/options/shared_options.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "app/options/numbers.h"
#include "lodestone/base/units.h"
#include "lodestone/chain/ladder/build_ladder.h"
#include "lodestone/measure/image.h"

namespace lodestone::app {
namespace {

std::vector<std::string> unit_names() {
  std::vector<std::string> names;
  for (const LengthUnit& unit : kLengthUnits) names.emplace_back(unit.name);
  return names;
}

OptionSpec ratio_option(const char* value, const char* text) {
  return {"--ratio", "", value, "", "share of the triangles kept, 0.1 or 10%", text, {}, Completion::none};
}
OptionSpec error_option(const char* value, const char* text) {
  return {"--error", "", value, "", "length: 0.1% or 0.001 of the diagonal, or 2mm", text, {}, Completion::none};
}
OptionSpec json_option() {
  return {"--json", "", "", "", "", "print exactly one JSON object instead of a table", {}, Completion::none};
}

}  // namespace

OptionGroup ladder_target_group() {
  const std::string levels = fmt::format("{}", chain::LadderOptions{}.levels);
  return {
      "Levels (one of these)",
      {{"--levels",
        "",
        "N",
        levels,
        "levels",
        fmt::format("N levels (2 to {}) with the original as level 0, each with half the triangles of the one before",
                    kMostLevels),
        {},
        Completion::none},
       ratio_option("R,...", "one level for each share"),
       {"--triangles", "", "N,...", "", "triangles", "one level for each count", {}, Completion::none},
       error_option("E,...", "one level for each error: the coarsest mesh whose measured error is within it"),
       {"--distances",
        "",
        "D,...",
        "",
        "length: model units, or 5m",
        "one level for each viewing distance: the coarsest whose error covers at most --pixels on the screen from "
        "there",
        {},
        Completion::none},
       {"--pixels", "", "P", "1", "pixels", "how large an error may look from --distances", {}, Completion::none}}};
}

OptionGroup view_group() {
  const measure::View view;
  return {
      "View",
      {{"--height", "", "N", fmt::format("{}", view.height_px), "lines", "height of the screen", {}, Completion::none},
       {"--fov",
        "",
        "A",
        fmt::format("{}", view.fov_degrees),
        "degrees",
        "vertical field of view",
        {},
        Completion::none}}};
}

OptionGroup single_target_group() {
  return {"Target (one of these)",
          {ratio_option("R", "keep this share"),
           {"--triangles", "", "N", "", "triangles", "stop at or below this count", {}, Completion::none},
           error_option("E", "the coarsest mesh whose measured error is within it")}};
}

OptionGroup effort_group() {
  return {"Effort",
          {{"--effort",
            "",
            "HOW",
            "",
            "",
            "how much work each level is worth. fast: edge collapse alone; normal: collapsed again with more triangles "
            "where the error is largest, about 4 times as long; best: vertices moved as well, about 20 times as long, "
            "for an error even more, but with about half of the triangles (without: normal for ladders and errors, "
            "fast for counts)",
            {"fast", "normal", "best"},
            Completion::choices}}};
}

chain::Effort effort_of(const Arguments& arguments, chain::Effort otherwise) {
  const std::string word = arguments.text("--effort");
  if (word == "best") return chain::Effort::best;
  if (word == "normal") return chain::Effort::normal;
  return word == "fast" ? chain::Effort::fast : otherwise;
}

OptionGroup unit_group() {
  return {"Lengths",
          {{"--unit", "", "U", "", "", "the model's unit (glTF is in metres; other formats don't say)", unit_names(),
            Completion::choices}}};
}

OptionGroup length_group() {
  OptionGroup group = unit_group();
  group.options.push_back({"--absolute",
                           "",
                           "",
                           "",
                           "",
                           "bare numbers of --error are model units, not shares of the diagonal",
                           {},
                           Completion::none});
  return group;
}

OptionGroup measuring_group(std::uint64_t samples) {
  return {"Measuring",
          {{"--samples",
            "",
            "N",
            fmt::format("{}", samples),
            "points",
            "points sampled on each surface, besides all vertices",
            {},
            Completion::none},
           {"--seed",
            "",
            "S",
            fmt::format("{}", measure::DistanceOptions{}.seed),
            "",
            "seed of the samples",
            {},
            Completion::none}}};
}

OptionGroup with_image_error(OptionGroup group) {
  group.options.push_back(
      {"--verify",
       "",
       "",
       "",
       "",
       "read every level back from the written files, measure it again, and fail if it differs from what was told",
       {},
       Completion::none});
  group.options.push_back({"--image-error",
                           "",
                           "",
                           "",
                           "",
                           "also compare pictures of each level with the original's, from 20 sides",
                           {},
                           Completion::none});
  return group;
}

OptionGroup with_bounded(OptionGroup group) {
  group.options.push_back({"--bounded",
                           "",
                           "T",
                           "",
                           "share or length",
                           "go on until the maximum is certain to within T, however long it takes",
                           {},
                           Completion::none});
  return group;
}

OptionGroup image_group() {
  return {
      "Pictures",
      {{"--image", "", "", "", "", "one more table: pictures of both from all sides, compared", {}, Completion::none},
       {"--views",
        "",
        "N",
        fmt::format("{}", measure::ImageOptions{}.views),
        "4, 6, 8, 12 or 20",
        "pictures to compare; needs --image",
        {},
        Completion::none},
       {"--heat",
        "",
        "FILE",
        "",
        "",
        "write A coloured by its distance to B, with the distance at each vertex as _ERROR (.glb, .gltf or .ply)",
        {},
        Completion::file}}};
}

OptionGroup attribute_group() {
  return {
      "Attributes",
      {{"--attributes",
        "",
        "",
        "",
        "",
        "a second table: normals, UVs, vertex colours, and colours as shown",
        {},
        Completion::none},
       {"--uv-set", "", "N", "", "", "of UVs this set alone (TEXCOORD_N); needs --attributes", {}, Completion::none}}};
}

OptionGroup output_group(bool compress) {
  OptionGroup group{"Output",
                    {{"--output", "-o", "OUTPUT", "", "", "file to write; never an input", {}, Completion::file}}};
  if (compress) {
    group.options.push_back({"--compress",
                             "",
                             "CODEC",
                             "none",
                             "",
                             "how geometry is coded in glTF",
                             {"none", "meshopt", "draco"},
                             Completion::choices});
  }
  group.options.push_back(json_option());
  return group;
}

OptionGroup input_level_group(const char* text) {
  return {"Input", {{"--level", "", "K", "0", "", text, {}, Completion::none}}};
}

OptionGroup with_report(OptionGroup group) {
  group.options.push_back(
      {"--report",
       "",
       "PAGE",
       "",
       "",
       "also write a page (.html) with figures, curves, warnings, and pictures of each level; {name} "
       "stands for the input's name",
       {},
       Completion::file});
  return group;
}

OptionGroup result_group() { return {"Output", {json_option()}}; }

OptionGroup general_group() {
  return {"General",
          {{"--threads",
            "",
            "N",
            "0",
            "threads",
            "at most N threads, 0 = all; the result is the same",
            {},
            Completion::none},
           {"--quiet",
            "-q",
            "",
            "",
            "",
            "print errors only: no table, progress or notes (JSON is still printed)",
            {},
            Completion::none},
           {"--verbose", "-v", "", "", "", "also print decisions and details", {}, Completion::none},
           {"--help", "-h", "", "", "", "this text", {}, Completion::none}}};
}

Result<std::string> given_target(const Arguments& arguments, const std::vector<std::string>& targets,
                                 const std::string& remedy) {
  std::vector<std::string> given;
  for (const std::string& target : targets) {
    if (arguments.has(target)) given.push_back(target);
  }
  if (given.empty()) return std::string();
  if (given.size() == 1) return given.front();
  return fail(ErrorCode::bad_argument, fmt::format("{} can't be given together", fmt::join(given, " and ")), {},
              remedy);
}

std::string unit_name(double meters_per_unit) {
  for (const LengthUnit& unit : kLengthUnits) {
    if (std::abs(meters_per_unit - unit.metres) <= 1e-9 * unit.metres) return std::string(unit.name);
  }
  return meters_per_unit > 0 ? fmt::format("{} m", meters_per_unit) : std::string();
}

Result<LengthRules> length_rules(const Arguments& arguments) {
  LengthRules rules;
  rules.absolute = arguments.has("--absolute");
  const std::string name = arguments.text("--unit");
  for (const LengthUnit& unit : kLengthUnits) {
    if (name == unit.name) rules.meters_per_unit = unit.metres;
  }
  return rules;
}

Result<std::vector<LengthArgument>> length_list(const Arguments& arguments, std::string_view option,
                                                const LengthRules& rules, BareLength bare) {
  std::vector<LengthArgument> lengths;
  const std::string list = arguments.text(option);
  if (const std::string meant = with_decimal_point(list); !meant.empty()) {
    return fail(decimal_comma(option, list, meant));
  }
  for (const std::string& word : split_commas(list)) {
    const Result<Length> parsed = parse_length(word);
    if (!parsed) {
      Error error = parsed.error();
      error.what = fmt::format("{} {}", option, error.what);
      return fail(error);
    }
    LengthArgument length{word, parsed->value, LengthArgument::Kind::relative};
    if (parsed->kind == Length::Kind::metres) {
      length.kind = LengthArgument::Kind::metres;
    } else if (word.back() != '%' && (rules.absolute || bare == BareLength::model_units)) {
      length.kind = LengthArgument::Kind::model_units;
    }
    if (!(length.value > 0)) {
      return fail(ErrorCode::bad_argument, fmt::format("{} is '{}', but it must be above 0", option, word));
    }
    lengths.push_back(std::move(length));
  }
  return lengths;
}

Result<std::vector<double>> to_model_units(const std::vector<LengthArgument>& lengths, const Model& model,
                                           double diagonal) {
  std::vector<double> values;
  for (const LengthArgument& length : lengths) {
    switch (length.kind) {
      case LengthArgument::Kind::relative:
        values.push_back(length.value * diagonal);
        break;
      case LengthArgument::Kind::model_units:
        values.push_back(length.value);
        break;
      case LengthArgument::Kind::metres:
        if (!(model.meters_per_unit > 0)) {
          return fail(ErrorCode::bad_argument,
                      fmt::format("'{}' has a unit, but the model's file has none", length.text), {},
                      "tell the model's unit with --unit mm (or cm, m, ...)");
        }
        values.push_back(length.value / model.meters_per_unit);
        break;
    }
  }
  return values;
}

void doubt_lengths(std::string_view option, const std::vector<LengthArgument>& lengths, const Model& model,
                   std::vector<std::string>& warnings) {
  constexpr double kMuch = 0.1;
  std::string unit = unit_name(model.meters_per_unit);
  if (unit.empty() || unit.find(' ') != std::string::npos) unit = "mm";
  for (const LengthArgument& length : lengths) {
    const bool bare = length.kind == LengthArgument::Kind::relative && length.text.back() != '%';
    if (!bare || length.value <= kMuch) continue;
    warnings.push_back(fmt::format("{0} {1} allows {2} of the diagonal; write {1}% for a share, or {1}{3} for a length",
                                   option, length.text, percent(length.value), unit));
  }
}

Result<std::vector<double>> ratio_list(const Arguments& arguments, std::string_view option) {
  std::vector<double> ratios;
  const std::string list = arguments.text(option);
  if (const std::string meant = with_decimal_point(list); !meant.empty()) {
    return fail(decimal_comma(option, list, meant));
  }
  for (const std::string& word : split_commas(list)) {
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    const std::string_view rest(end, static_cast<std::size_t>(word.data() + word.size() - end));
    if (rest == "%") value /= 100;
    if (error != std::errc{} || !(rest.empty() || rest == "%") || !(value > 0 && value < 1)) {
      return fail(ErrorCode::bad_argument,
                  fmt::format("{} '{}' is not a share between 0 and 1 (or 0% and 100%)", option, word), {},
                  "0.1 and 10% both keep a tenth of the triangles");
    }
    ratios.push_back(value);
  }
  return ratios;
}

Result<measure::DistanceOptions> distance_options(const Arguments& arguments) {
  measure::DistanceOptions options;
  const Result<std::uint64_t> samples = arguments.count("--samples", 1);
  LODESTONE_TRY(samples);
  const Result<std::uint64_t> seed = arguments.count("--seed");
  LODESTONE_TRY(seed);
  options.samples = *samples;
  options.seed = *seed;
  return options;
}

Result<measure::View> view_of(const Arguments& arguments) {
  measure::View view;
  const Result<double> height = arguments.positive("--height");
  LODESTONE_TRY(height);
  const Result<double> fov = arguments.positive("--fov");
  LODESTONE_TRY(fov);
  if (*fov >= 180) return fail(ErrorCode::bad_argument, fmt::format("--fov is {}, but it must be below 180", *fov));
  view.height_px = *height;
  view.fov_degrees = *fov;
  return view;
}

io::Compression compression_of(const Arguments& arguments) {
  const std::string codec = arguments.text("--compress");
  return codec == "meshopt" ? io::Compression::meshopt
         : codec == "draco" ? io::Compression::draco
                            : io::Compression::none;
}

void apply_unit(Model& model, const LengthRules& rules) {
  if (rules.meters_per_unit > 0) model.meters_per_unit = rules.meters_per_unit;
}

}  // namespace lodestone::app
