#include "lodestone/render/render.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <span>

#include "app/input.h"
#include "app/options/render_options.h"
#include "app/options/shared_options.h"
#include "app/output/json.h"
#include "app/output/text.h"
#include "app/verbs/picture.h"
#include "app/verbs/render_sheet.h"
#include "app/verbs/verbs.h"
#include "lodestone/base/file.h"
#include "lodestone/base/stopwatch.h"
#include "lodestone/base/units.h"
#include "lodestone/io/images/decode.h"
#include "lodestone/io/images/encode.h"

namespace lodestone::app {
namespace {

// What is asked for, checked before anything is read.
struct Request {
  std::string input, output, attribute;
  std::optional<render::Shading> shading;
  CameraChoice camera;
  render::RenderOptions options;
  std::size_t level = 0;
};

// Numbers are shown by heat alone, and heat shows numbers.
Result<void> read_heat(const Arguments& arguments, Request& request) {
  request.attribute = arguments.text("--attribute");
  if (request.attribute.empty() && request.shading == render::Shading::heat) {
    return fail(ErrorCode::bad_argument, "--shading heat needs the numbers to show", {},
                "add --attribute NAME; 'lod info' lists a model's attributes");
  }
  if (!request.attribute.empty() && !request.shading) request.shading = render::Shading::heat;
  if (request.shading == render::Shading::heat) return {};
  for (const char* option : {"--attribute", "--range"}) {
    if (!arguments.has(option)) continue;
    return fail(ErrorCode::bad_argument, fmt::format("{} needs --shading heat", option), {}, "add it");
  }
  return {};
}

Result<Request> request_of(const Arguments& arguments) {
  Request request;
  request.input = arguments.inputs.front();
  request.shading = shading_of(arguments.text("--shading"));
  LODESTONE_TRY(read_heat(arguments, request));
  const Result<CameraChoice> camera = camera_choice(arguments);
  LODESTONE_TRY(camera);
  const Result<render::RenderOptions> options = render_options(arguments);
  LODESTONE_TRY(options);
  const Result<std::uint64_t> level = arguments.count("--level", 0, 1024);
  LODESTONE_TRY(level);
  const Result<std::string> output = picture_output(arguments);
  LODESTONE_TRY(output);
  request.camera = *camera;
  request.options = *options;
  request.level = static_cast<std::size_t>(*level);
  request.output = *output;
  return request;
}

// What only --sheet knows.
Result<void> check_one_picture(const Arguments& arguments) {
  if (const std::string remedy = forgotten_output(arguments); !remedy.empty()) {
    return fail(ErrorCode::bad_argument, "render needs an output", {}, remedy);
  }
  if (arguments.inputs.size() > 1) {
    return fail(ErrorCode::bad_argument, fmt::format("render draws one model, but got {}", arguments.inputs.size()), {},
                "add --sheet to draw them beside each other, as levels of the first");
  }
  for (const char* option : {"--height", "--pixels"}) {
    if (arguments.has(option)) {
      return fail(ErrorCode::bad_argument, fmt::format("{} needs --sheet", option), {}, "add it");
    }
  }
  return {};
}

std::array<double, 3> triple(Vec3d v) { return {v.x, v.y, v.z}; }

}  // namespace

Result<ExitCode> run_render(const Arguments& arguments, Console& console) {
  if (arguments.has("--sheet")) return run_sheet(arguments, console);
  LODESTONE_TRY(check_one_picture(arguments));
  const Result<Request> asked = request_of(arguments);
  LODESTONE_TRY(asked);
  const Request& request = *asked;
  RenderReport report;
  report.input = request.input;
  report.file = request.output;
  report.level = request.level;

  Stopwatch watch;
  const Result<VolumeRequest> volume = volume_request(arguments);
  LODESTONE_TRY(volume);
  const Result<LengthRules> lengths = length_rules(arguments);
  LODESTONE_TRY(lengths);
  Result<Model> model = read_drawn_level(request.input, request.level, report.warnings, console,
                                         console.task().part(0.5, "reading"), *volume);
  LODESTONE_TRY(model);
  apply_unit(*model, *lengths);
  LODESTONE_TRY(check_picture_kept(*model, request.output));
  report.read_seconds = watch.lap();

  render::SceneOptions scene_options;
  scene_options.attribute = request.attribute;
  const Result<render::Scene> scene =
      render::Scene::create(*model, scene_options, console.task().part(0.2, "preparing"));
  LODESTONE_TRY(scene);
  report.triangles = scene->triangle_count();
  report.prepare_seconds = watch.lap();

  render::RenderOptions options = request.options;
  options.shading = request.shading.value_or(render::default_shading(*scene));
  report.shading = name_of(options.shading);
  if (options.shading == render::Shading::textured) {
    for (const std::string& note : scene->notes()) {
      console.note(fmt::format("{}: {}", request.input, note));
      report.warnings.push_back(note);
    }
  }
  if (options.shading == render::Shading::heat) {
    const render::HeatRange range = options.heat_range.value_or(render::default_heat_range(*scene));
    report.heat_range = {range.least, range.largest};
    if (request.attribute == "_ERROR") options.unit = unit_name(model->meters_per_unit);  // as measure --heat writes it
  }
  const Camera camera = request.camera.camera(*scene, static_cast<double>(options.width) / options.height);
  report.eye = triple(camera.eye);
  report.forward = triple(camera.forward);
  report.up = triple(camera.up);
  const Result<Pixels> picture = render::render(*scene, camera, options, console.task().part(0.2, "drawing"));
  LODESTONE_TRY(picture);
  report.width = picture->width;
  report.height = picture->height;
  report.draw_seconds = watch.lap();

  const Result<std::uint64_t> written = io::write_picture(*picture, request.output);
  LODESTONE_TRY(written);
  console.wrote(request.output);
  report.bytes = *written;
  report.write_seconds = watch.lap();
  arguments.has("--json")
      ? console.result(to_json(report))
      : console.table(fmt::format("{}: {} x {} pixels, {} triangles, {}\n", printable(report.file), report.width,
                                  report.height, with_separators(report.triangles), human_bytes(report.bytes)));
  return ExitCode::done;
}

}  // namespace lodestone::app
