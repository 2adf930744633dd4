#include "app/options/render_options.h"
#include "lodestone/base/units.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <vector>

namespace lodestone::app {
namespace {

using render::Shading;

constexpr std::pair<const char*, Shading> kShadings[] = {
    {"smooth", Shading::smooth},      {"flat", Shading::flat},       {"textured", Shading::textured},
    {"color", Shading::vertex_color}, {"normals", Shading::normals}, {"face-normals", Shading::face_normals},
    {"heat", Shading::heat}};

const std::vector<std::string>& view_names() {
  static const std::vector<std::string> names{"front", "back", "left", "right", "top", "bottom", "iso"};
  return names;
}

// Finite numbers separated by commas.
Result<std::vector<double>> numbers(const Arguments& arguments, const char* option, std::size_t count,
                                    const char* example) {
  const std::string text = arguments.text(option);
  std::vector<double> values;
  for (const std::string& word : split_commas(text)) {
    const std::optional<double> value = parse_number(word);
    if (!value) break;
    values.push_back(*value);
  }
  if (values.size() == count && split_commas(text).size() == count) return values;
  return fail(ErrorCode::bad_argument,
              fmt::format("{} is '{}', but it must be {} numbers separated by commas", option, text, count), {},
              fmt::format("as in {}", example));
}

Result<Vec3d> vector(const Arguments& arguments, const char* option) {
  const Result<std::vector<double>> v = numbers(arguments, option, 3, fmt::format("{}=0,1.5,4", option).c_str());
  LODESTONE_TRY(v);
  return Vec3d{(*v)[0], (*v)[1], (*v)[2]};
}

Result<void> read_look_at(const Arguments& arguments, CameraChoice& choice) {
  for (const auto& [option, into] : {std::pair{"--eye", &choice.eye}, std::pair{"--target", &choice.target}}) {
    if (!arguments.has(option)) continue;
    const Result<Vec3d> point = vector(arguments, option);
    LODESTONE_TRY(point);
    *into = *point;
  }
  if (choice.target && !choice.eye) {
    return fail(ErrorCode::bad_argument, "--target needs --eye", {}, "add --eye X,Y,Z");
  }
  if (choice.eye && choice.target && *choice.eye == *choice.target) {
    return fail(ErrorCode::bad_argument, "--eye and --target are the same point", {}, "move one of them");
  }
  const std::string axis = arguments.text("--up");  // the names that other verbs have for it
  const Result<Vec3d> up = axis == "y"   ? Result<Vec3d>(Vec3d{0, 1, 0})
                           : axis == "z" ? Result<Vec3d>(Vec3d{0, 0, 1})
                                         : vector(arguments, "--up");
  LODESTONE_TRY(up);
  if (*up == Vec3d{}) {
    return fail(ErrorCode::bad_argument, "--up is no direction", {}, "use --up y or --up z");
  }
  choice.up = *up;
  return {};
}

Result<std::array<std::uint32_t, 2>> size_of_picture(const Arguments& arguments) {
  const std::string text = arguments.text("--size");
  std::array<std::uint32_t, 2> size{};
  const char* end = text.data() + text.size();
  const auto [middle, error] = std::from_chars(text.data(), end, size[0]);
  if (error == std::errc{} && middle != end && *middle == 'x') {
    const auto [last, second_error] = std::from_chars(middle + 1, end, size[1]);
    const auto fits = [](std::uint32_t side) { return side >= 1 && side <= render::kMostSide; };
    if (second_error == std::errc{} && last == end && fits(size[0]) && fits(size[1])) return size;
  }
  return fail(ErrorCode::bad_argument,
              fmt::format("--size is '{}', but it must be WxH with sides of 1 to {} pixels", text, render::kMostSide),
              {}, "as in --size 1280x720");
}

Result<std::array<std::uint8_t, 4>> background(const Arguments& arguments) {
  const std::string text = arguments.text("--background");
  if (text == "none") return std::array<std::uint8_t, 4>{0, 0, 0, 0};
  if (text == "white") return std::array<std::uint8_t, 4>{255, 255, 255, 255};
  if (text == "black") return std::array<std::uint8_t, 4>{0, 0, 0, 255};
  std::array<std::uint8_t, 4> color{0, 0, 0, 255};
  const std::size_t first = !text.empty() && text[0] == '#' ? 1 : 0;
  bool good = text.size() == first + 6 || text.size() == first + 8;
  for (std::size_t k = 0; good && first + 2 * k < text.size(); ++k) {
    const char* at = text.data() + first + 2 * k;
    const auto [end, error] = std::from_chars(at, at + 2, color[k], 16);
    good = error == std::errc{} && end == at + 2;
  }
  if (good) return color;
  return fail(ErrorCode::bad_argument,
              fmt::format("--background is '{}', but it must be RRGGBB, RRGGBBAA, white, black or none", text), {},
              "as in --background ffffff");
}

}  // namespace

OptionGroup camera_group() {
  return {
      "Camera",
      {{"--view", "", "V", "", "", "by name; without: 20 degrees right of the front, 15 above", view_names(),
        Completion::choices},
       {"--angles", "", "AZ,EL", "", "degrees", "from AZ to the right of the front, EL above", {}, Completion::none},
       {"--eye", "", "X,Y,Z", "", "model units", "from this point", {}, Completion::none},
       {"--target",
        "",
        "X,Y,Z",
        "",
        "model units",
        "--eye looks here (without: at the middle of the model)",
        {},
        Completion::none},
       {"--up", "", "AXIS", "0,1,0", "", "what is up: y, z or any direction", {}, Completion::none},
       {"--fov", "", "A", "45", "degrees", "vertical field of view", {}, Completion::none},
       {"--ortho", "", "", "", "", "without perspective", {}, Completion::none}}};
}

OptionGroup look_group() {
  std::vector<std::string> shadings;
  for (const auto& [name, shading] : kShadings) shadings.emplace_back(name);
  return {"Look",
          {{"--shading", "", "S", "", "",
            "what colours mean; without: textured if there are textures, else color if there are vertex colours, else "
            "smooth",
            shadings, Completion::choices},
           {"--wireframe", "", "", "", "", "draw the triangles' edges on top", {}, Completion::none},
           {"--background",
            "",
            "C",
            "eceef1",
            "RRGGBB or RRGGBBAA",
            "white, black, none (clear) or a colour",
            {},
            Completion::none},
           {"--attribute", "", "NAME", "", "", "the numbers that heat shows, such as _ERROR", {}, Completion::none},
           {"--range",
            "",
            "LOW,HIGH",
            "",
            "units of the attribute",
            "the ends of heat's colours (without: from what is there)",
            {},
            Completion::none},
           {"--level",
            "",
            "K",
            "0",
            "",
            "which level of a ladder in a glTF file; 0 = the original",
            {},
            Completion::none}}};
}

OptionGroup picture_group() {
  return {"Output",
          {{"--output", "-o", "PICTURE", "", "", "file to write, .png or .webp; never an input", {}, Completion::file},
           {"--size", "", "WxH", "1280x720", "pixels", "width and height of the picture", {}, Completion::none},
           {"--samples", "", "N", "4", "a pixel", "4 smooths edges, 1 does not", {"1", "4"}, Completion::choices},
           {"--json", "", "", "", "", "print exactly one JSON object instead of a line", {}, Completion::none}}};
}

Camera CameraChoice::camera(const render::Scene& scene, double aspect) const {
  if (eye) return look_at(*eye, target.value_or(scene.bounds().center()), up, lens);
  return scene.framed(angles, aspect, lens, up);
}

Result<CameraChoice> camera_choice(const Arguments& arguments) {
  CameraChoice choice;
  choice.angles = {20, 15};
  int ways = 0;
  for (const char* option : {"--view", "--angles", "--eye"}) ways += arguments.has(option) ? 1 : 0;
  if (ways > 1) {
    return fail(ErrorCode::bad_argument, "--view, --angles and --eye can't be given together", {},
                "keep the one that says where to look from");
  }
  if (arguments.has("--view")) choice.angles = named_view(arguments.text("--view")).value_or(choice.angles);
  if (arguments.has("--angles")) {
    const Result<std::vector<double>> angles = numbers(arguments, "--angles", 2, "--angles=30,20");
    LODESTONE_TRY(angles);
    choice.angles = {(*angles)[0], (*angles)[1]};
    if (std::abs(choice.angles.elevation_degrees) > 90) {
      return fail(ErrorCode::bad_argument,
                  fmt::format("the second of --angles is {}, but it must be from -90 to 90", (*angles)[1]), {},
                  "90 looks from straight above");
    }
  }
  LODESTONE_TRY(read_look_at(arguments, choice));
  const Result<double> fov = arguments.positive("--fov");
  LODESTONE_TRY(fov);
  if (*fov >= 180) return fail(ErrorCode::bad_argument, fmt::format("--fov is {}, but it must be below 180", *fov));
  choice.lens = {arguments.has("--ortho"), *fov};
  return choice;
}

Result<render::RenderOptions> render_options(const Arguments& arguments) {
  render::RenderOptions options;
  const auto size = size_of_picture(arguments);
  LODESTONE_TRY(size);
  options.width = (*size)[0];
  options.height = (*size)[1];
  options.samples = arguments.text("--samples") == "1" ? 1 : 4;
  options.wireframe = arguments.has("--wireframe");
  const auto color = background(arguments);
  LODESTONE_TRY(color);
  options.background = *color;
  if (arguments.has("--range")) {
    const Result<std::vector<double>> range = numbers(arguments, "--range", 2, "--range 0,0.5");
    LODESTONE_TRY(range);
    options.heat_range = render::HeatRange{(*range)[0], (*range)[1]};
    if (!((*range)[0] < (*range)[1])) {
      return fail(ErrorCode::bad_argument, "--range must rise", {}, "as in --range 0,0.5");
    }
  }
  return options;
}

std::optional<Shading> shading_of(const std::string& name) {
  for (const auto& [known, shading] : kShadings) {
    if (name == known) return shading;
  }
  return std::nullopt;
}

const char* name_of(Shading shading) {
  for (const auto& [name, known] : kShadings) {
    if (known == shading) return name;
  }
  return "";
}

}  // namespace lodestone::app
