#include "app/verbs/render_sheet.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/options/render_options.h"
#include "app/options/shared_options.h"
#include "app/output/json.h"
#include "app/output/text.h"
#include "app/verbs/picture.h"
#include "lodestone/base/file.h"
#include "lodestone/base/stopwatch.h"
#include "lodestone/base/units.h"
#include "lodestone/io/gltf/levels.h"
#include "lodestone/io/images/encode.h"
#include "lodestone/measure/distance.h"
#include "lodestone/report/contact_sheet.h"

namespace lodestone::app {
namespace {

struct Request {
  std::string output;
  std::optional<render::Shading> shading;
  report::SheetOptions options;
  LengthRules lengths;
  VolumeRequest volume;
};

// Options that say how one picture is taken, where a sheet takes many.
Result<void> check_options(const Arguments& arguments) {
  for (const char* option : {"--level", "--eye", "--target", "--attribute", "--range"}) {
    if (!arguments.has(option)) continue;
    return fail(ErrorCode::bad_argument, fmt::format("{} and --sheet can't be given together", option), {},
                "leave one of them out");
  }
  if (arguments.text("--shading") != "heat") return {};
  return fail(ErrorCode::bad_argument, "a sheet shows no heat", {}, "choose another --shading");
}

Result<Request> request_of(const Arguments& arguments) {
  LODESTONE_TRY(check_options(arguments));
  Request request;
  request.shading = shading_of(arguments.text("--shading"));
  const Result<CameraChoice> camera = camera_choice(arguments);
  LODESTONE_TRY(camera);
  const Result<render::RenderOptions> picture = render_options(arguments);
  LODESTONE_TRY(picture);
  const Result<measure::View> view = view_of(arguments);
  LODESTONE_TRY(view);
  const Result<double> pixels = arguments.positive("--pixels");
  LODESTONE_TRY(pixels);
  Result<std::string> output = picture_output(arguments);
  LODESTONE_TRY(output);
  request.output = std::move(*output);
  request.options.picture = *picture;
  if (!arguments.has("--size")) {
    request.options.picture.width = 480;
    request.options.picture.height = 360;
  }
  request.options.angles = camera->angles;
  request.options.lens = camera->lens;
  request.options.up = camera->up;
  request.options.view = *view;
  const Result<LengthRules> lengths = length_rules(arguments);
  LODESTONE_TRY(lengths);
  request.lengths = *lengths;
  Result<VolumeRequest> volume = volume_request(arguments);
  LODESTONE_TRY(volume);
  request.volume = std::move(*volume);
  request.volume.asked = false;  // of several files each is what its name says
  request.options.pixels = *pixels;
  return request;
}

// A file and a level of it.
struct Source {
  std::string file;
  std::size_t level = 0;
};

Result<std::vector<Source>> sources_of(const std::vector<std::string>& inputs) {
  std::vector<Source> sources;
  if (inputs.size() == 1) {
    if (const auto there = InputFile::open(inputs.front()); !there) return fail(there.error());
    const std::uint64_t levels = io::levels_in_file(inputs.front());
    if (levels < 2) {
      return fail(ErrorCode::bad_argument, "has no levels (MSFT_lod) for a sheet", inputs.front(),
                  "make them with 'lod build', or name the original and its levels as files");
    }
    if (levels > kMostLevels) {
      return fail(ErrorCode::bad_argument, fmt::format("has {} levels, a sheet has at most {}", levels, kMostLevels),
                  inputs.front());
    }
    for (std::size_t level = 0; level < levels; ++level) sources.push_back({inputs.front(), level});
    return sources;
  }
  if (inputs.size() > kMostLevels) {
    return fail(ErrorCode::bad_argument,
                fmt::format("{} models were given, a sheet has at most {}", inputs.size(), kMostLevels));
  }
  for (const std::string& input : inputs) sources.push_back({input, 0});
  return sources;
}

// Errors are measured anew, so that any files will do. Along a ladder in one file they never fall; files that were
// given one by one may come from anywhere, and each has its own.
Result<std::vector<report::SheetLevel>> read_levels(const std::vector<Source>& sources, const Request& request,
                                                    SheetReport& report, const Console& console) {
  std::vector<report::SheetLevel> levels;
  std::optional<measure::Reference> reference;
  const Task all = console.task().part(0.8);
  for (const Source& source : sources) {
    const Task task = all.part(1.0 / static_cast<double>(sources.size()), fmt::format("level {}", levels.size()));
    Result<Model> model =
        read_drawn_level(source.file, source.level, report.warnings, console, task.part(0.3), request.volume);
    LODESTONE_TRY(model);
    apply_unit(*model, request.lengths);
    LODESTONE_TRY(check_picture_kept(*model, request.output));
    double error = 0;
    if (!reference) {
      Result<measure::Reference> made = measure::Reference::create(*model, task.part(0.3));
      LODESTONE_TRY(made);
      reference.emplace(std::move(*made));
      report.unit = unit_name(model->meters_per_unit);
    } else {
      const Result<measure::Distance> distance = reference->distance_to(*model, {}, task.part(0.3));
      LODESTONE_TRY(distance);
      const bool ladder = source.file == sources.front().file;
      error = ladder ? std::max(levels.back().error, distance->trusted_max()) : distance->trusted_max();
    }
    Result<render::Scene> scene = render::Scene::create(*model, {}, task.part(0.3));
    LODESTONE_TRY(scene);
    levels.push_back({std::move(*scene), error});
  }
  return levels;
}

std::string line_of(const SheetReport& report) {
  return fmt::format("{}: {} levels, {} x {} pixels, {}\n", printable(report.file), report.levels.size(), report.width,
                     report.height, human_bytes(report.bytes));
}

}  // namespace

OptionGroup sheet_group() {
  return {"Sheet",
          {{"--sheet",
            "",
            "",
            "",
            "",
            "all levels of a ladder beside each other (or the files given, the original first), with their errors: "
            "above from one camera, below from where each takes over",
            {},
            Completion::none},
           {"--height",
            "",
            "N",
            "1080",
            "lines",
            "height of the screen that the lower row is taken from",
            {},
            Completion::none},
           {"--pixels",
            "",
            "P",
            "1",
            "pixels",
            "what an error may cover where its level takes over",
            {},
            Completion::none}}};
}

Result<ExitCode> run_sheet(const Arguments& arguments, Console& console) {
  Result<Request> request = request_of(arguments);
  LODESTONE_TRY(request);
  const Result<std::vector<Source>> sources = sources_of(arguments.inputs);
  LODESTONE_TRY(sources);
  Stopwatch watch;
  SheetReport report;
  report.file = request->output;
  const Result<std::vector<report::SheetLevel>> levels = read_levels(*sources, *request, report, console);
  LODESTONE_TRY(levels);
  report::SheetOptions& options = request->options;
  options.unit = report.unit;
  options.picture.shading = request->shading.value_or(render::default_shading(levels->front().scene));
  report.shading = name_of(options.picture.shading);
  const Result<Pixels> sheet = report::contact_sheet(*levels, options, console.task().part(0.2, "drawing"));
  LODESTONE_TRY(sheet);
  const Result<std::uint64_t> written = io::write_picture(*sheet, report.file);
  LODESTONE_TRY(written);
  console.wrote(report.file);
  for (std::size_t i = 0; i < levels->size(); ++i) {
    const report::SheetLevel& level = (*levels)[i];
    report.levels.push_back({(*sources)[i].file, (*sources)[i].level, level.scene.triangle_count(), level.error,
                             measure::switch_distance(level.error, options.pixels, options.view)});
  }
  report.width = sheet->width;
  report.height = sheet->height;
  report.bytes = *written;
  report.seconds = watch.total();
  arguments.has("--json") ? console.result(to_json(report)) : console.table(line_of(report));
  return ExitCode::done;
}

}  // namespace lodestone::app
