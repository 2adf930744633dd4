#include "app/options/constraints.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "app/options/attributes.h"
#include "app/output/text.h"
#include "lodestone/base/file.h"
#include "lodestone/base/units.h"
#include "lodestone/chain/ladder/thin_model.h"

namespace lodestone::app {
namespace {

constexpr const char* kFileRemedy = "a line is X Y Z RADIUS WEIGHT, or X Y Z RADIUS lock";

bool read_number(std::string_view text, double& out) {
  const std::optional<double> number = parse_number(text);
  out = number.value_or(0);
  return number.has_value();
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
bool read_sphere(const std::vector<std::string_view>& words, chain::ConstraintSphere& out) {
  return words.size() >= 4 && read_number(words[0], out.center.x) && read_number(words[1], out.center.y) &&
         read_number(words[2], out.center.z) && read_number(words[3], out.radius) && out.radius > 0;
}

// Hands each line of a text file that holds more than a comment to read(words); false = the line is wrong.
template <class Read>
Result<void> read_lines(const std::filesystem::path& path, const char* wrong, const char* remedy, const Read& read) {
  const Result<std::string> text = read_file(path);
  LODESTONE_TRY(text);
  std::size_t number = 0;
  for (std::size_t at = 0; at < text->size();) {
    const std::size_t end = std::min(text->find('\n', at), text->size());
    const std::string_view line = std::string_view(*text).substr(at, end - at);
    at = end + 1;
    ++number;
    const std::vector<std::string_view> words = words_of(line);
    if (words.empty() || words[0].starts_with('#')) continue;
    const std::string place = fmt::format("{}: line {}", path.string(), number);
    if (!read(words, place)) {
      return fail(ErrorCode::bad_format, fmt::format("'{}' {}", printable(std::string(line.substr(0, 60))), wrong),
                  place, remedy);
    }
  }
  return {};
}

Result<void> read_weights(const std::filesystem::path& path, ConstraintPlan& plan) {
  return read_lines(
      path, "is no sphere", kFileRemedy, [&](const std::vector<std::string_view>& words, const std::string& place) {
        chain::ConstraintSphere sphere;
        sphere.no_move = words.size() == 5 && words[4] == "lock";
        const bool good = words.size() == 5 && read_sphere(words, sphere) &&
                          (sphere.no_move || (read_number(words[4], sphere.weight) && sphere.weight >= 0));
        plan.constraints.spheres.push_back(sphere);
        plan.sphere_places.push_back(place);
        return good;
      });
}

bool read_count(std::string_view text, std::uint64_t& out) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
  return error == std::errc{} && end == text.data() + text.size();
}

Result<void> read_only(const std::filesystem::path& path, ConstraintPlan& plan) {
  constexpr const char* kRemedy = "a line is a triangle's number, from 0, or a range such as 100-199";
  Result<void> read = read_lines(
      path, "is no triangle", kRemedy, [&](const std::vector<std::string_view>& words, const std::string& place) {
        chain::TriangleRange range;
        const std::size_t dash = words[0].find('-');
        const bool good = words.size() == 1 && read_count(words[0].substr(0, dash), range.first) &&
                          (dash == std::string_view::npos || read_count(words[0].substr(dash + 1), range.last));
        if (dash == std::string_view::npos) range.last = range.first;
        plan.constraints.only.push_back(range);
        plan.only_places.push_back(place);
        return good && range.first <= range.last;
      });
  if (!read) return read;
  if (plan.constraints.only.empty()) {
    return fail(ErrorCode::bad_format, "names no triangle", path.string(), kRemedy);
  }
  return {};
}

Result<void> read_lock(const std::string& text, ConstraintPlan& plan) {
  const std::vector<std::string> parts = split_commas(text);
  chain::ConstraintSphere sphere;
  sphere.no_move = true;
  if (parts.size() != 4 || !read_sphere({parts.begin(), parts.end()}, sphere)) {
    return fail(ErrorCode::bad_argument, fmt::format("--lock {} is no sphere", text), {},
                "four numbers, X,Y,Z,RADIUS, the radius above 0; several spheres go into a file for --weights");
  }
  plan.constraints.spheres.push_back(sphere);
  plan.sphere_places.push_back(fmt::format("--lock {}", text));
  return {};
}

Result<std::optional<LengthArgument>> one_length(const Arguments& arguments, const char* option,
                                                 const LengthRules& lengths) {
  if (!arguments.has(option)) return std::nullopt;
  const Result<std::vector<LengthArgument>> list = length_list(arguments, option, lengths, BareLength::model_units);
  LODESTONE_TRY(list);
  if (list->size() == 1) return list->front();
  return fail(ErrorCode::bad_argument, fmt::format("{} takes one length", option), {},
              fmt::format("such as {} 1mm", option));
}

std::vector<OptionSpec> vertex_options() {
  return {
      {"--keep-border", "", "", "", "", "open borders stay exactly as they are", {}, Completion::none},
      {"--lock", "", "X,Y,Z,R", "", "model units", "vertices in this sphere stay where they are", {}, Completion::none},
      {"--weld",
       "",
       "LENGTH",
       "",
       "model units",
       "join vertices nearer than this before simplifying (1mm and 0.01% work, too); vertices at the same position "
       "are joined anyway",
       {},
       Completion::none},
      {"--join",
       "",
       "LENGTH",
       "",
       "model units",
       "sew borders of separate parts together that are nearer than this before simplifying",
       {},
       Completion::none}};
}

std::vector<OptionSpec> part_options() {
  return {
      {"--prune",
       "",
       "",
       "",
       "",
       "let separate parts vanish where that adds no larger error than the level has",
       {},
       Completion::none},
      {"--keep-area",
       "",
       "",
       "",
       "",
       "as --prune, and let the parts that stay grow to cover the area of those that went: for foliage and lattices",
       {},
       Completion::none},
      {"--keep-parts",
       "",
       "",
       "",
       "",
       "keep every part; without it, models of many thin parts (trees, towers) whose levels would leave each only a "
       "few triangles are built with --keep-area",
       {},
       Completion::none}};
}

std::vector<OptionSpec> other_options() {
  return {
      {"--force",
       "",
       "",
       "",
       "",
       "write the levels asked for by count, however large their errors; without it, a ladder ends before an error "
       "that is more than twice what the finer levels lead one to expect",
       {},
       Completion::none},
      {"--only",
       "",
       "FILE",
       "",
       "",
       "change only the triangles listed in FILE, one number (from 0) or range A-B a line; all others stay exactly as "
       "they are",
       {},
       Completion::file},
      {"--weight-by",
       "",
       "NAME",
       "",
       "",
       "the vertex attribute that says how much each vertex matters: 1 is usual, 10 keeps about 3 times finer detail",
       {},
       Completion::none},
      {"--weights",
       "",
       "FILE",
       "",
       "",
       "spheres in which vertices matter more: lines of X Y Z RADIUS WEIGHT, or lock in place of WEIGHT",
       {},
       Completion::file}};
}

}  // namespace

OptionGroup method_group() {
  OptionGroup group{"Method", vertex_options()};
  for (const auto& options : {part_options(), other_options()}) {
    group.options.insert(group.options.end(), options.begin(), options.end());
  }
  return group;
}

Result<ConstraintPlan> constraints_of(const Arguments& arguments, const LengthRules& lengths) {
  ConstraintPlan plan;
  plan.constraints.keep_border = arguments.has("--keep-border");
  plan.constraints.weight_attribute = arguments.text("--weight-by");
  plan.constraints.prune = arguments.has("--prune");
  plan.constraints.keep_area = arguments.has("--keep-area");
  plan.keep_parts = arguments.has("--keep-parts");
  if (plan.keep_parts && plan.constraints.vanishes()) {
    return fail(ErrorCode::bad_argument, "--keep-parts and --prune or --keep-area are asked for at once", {},
                "choose one");
  }
  if (arguments.has("--lock")) {
    LODESTONE_TRY(read_lock(arguments.text("--lock"), plan));
  }
  if (arguments.has("--weights")) {
    LODESTONE_TRY(read_weights(arguments.text("--weights"), plan));
  }
  if (arguments.has("--only")) {
    LODESTONE_TRY(read_only(arguments.text("--only"), plan));
  }
  LODESTONE_TRY(read_attribute_options(arguments, plan.constraints));
  Result<std::optional<LengthArgument>> weld = one_length(arguments, "--weld", lengths);
  LODESTONE_TRY(weld);
  plan.weld = std::move(*weld);
  Result<std::optional<LengthArgument>> join = one_length(arguments, "--join", lengths);
  LODESTONE_TRY(join);
  plan.join = std::move(*join);
  return plan;
}

namespace {

// A tree or a lattice needs parts that vanish while others grow, or its levels are ruins.
void choose_keep_area(const Model& model, std::size_t smallest, chain::SimplifyConstraints& constraints,
                      std::vector<std::string>& warnings, const Task& task) {
  const chain::ThinShare share = chain::thin_share(model, task);
  if (!chain::needs_keep_area(share, smallest)) return;
  constraints.keep_area = true;
  warnings.push_back(
      fmt::format("{} parts, {} of the area in thin ones: small parts may vanish and others grow, as by --keep-area "
                  "(--keep-parts: none vanishes)",
                  with_separators(share.parts), percent(share.area)));
}

}  // namespace

Result<chain::SimplifyConstraints> ConstraintPlan::for_model(const Model& model, std::size_t smallest,
                                                             std::vector<std::string>& warnings,
                                                             const Task& task) const {
  chain::SimplifyConstraints out = constraints;
  if (!keep_parts && !constraints.vanishes() && constraints.only.empty()) {
    choose_keep_area(model, smallest, out, warnings, task);
    if (task.cancelled()) return cancelled_error("looking for thin parts");
  }
  for (const std::size_t sphere : chain::empty_spheres(model, constraints.spheres)) {
    warnings.push_back(fmt::format("{}: this sphere holds no vertex", sphere_places[sphere]));
  }
  tell_of_attributes(model, constraints, warnings);
  std::uint64_t triangles = 0;
  for (const Mesh& mesh : model.meshes) triangles += mesh.triangles.size();
  for (std::size_t i = 0; i < constraints.only.size(); ++i) {
    if (constraints.only[i].last < triangles) continue;
    return fail(ErrorCode::bad_format, fmt::format("there is no triangle {}", constraints.only[i].last), only_places[i],
                fmt::format("the model has {}, counted from 0", with_separators(triangles)));
  }
  const auto in_model = [&](const std::optional<LengthArgument>& length, double& into) -> Result<void> {
    if (!length) return {};
    const Result<std::vector<double>> value = to_model_units({*length}, model, bounds_of(model).diagonal());
    LODESTONE_TRY(value);
    into = value->front();
    return {};
  };
  LODESTONE_TRY(in_model(weld, out.weld_tolerance));
  LODESTONE_TRY(in_model(join, out.join_length));
  return out;
}

}  // namespace lodestone::app
