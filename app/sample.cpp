#include <fmt/format.h>

#include "app/input.h"
#include "app/json.h"
#include "app/samples.h"
#include "app/text.h"
#include "app/verbs.h"
#include "lodestone/base/stopwatch.h"
#include "lodestone/base/units.h"
#include "lodestone/io/write.h"

namespace lodestone::app {
namespace {

constexpr std::size_t kDefaultTriangles = 100'000, kDefaultTowerTriangles = 20'000;

Result<Model> make_sphere_of(const Arguments& arguments, std::size_t triangles, const Task& task) {
  if (arguments.has("--triangles")) {
    if (arguments.has("--level")) {
      return fail(ErrorCode::bad_argument, "--triangles and --level can't be given together", {}, "choose one");
    }
    return make_sphere(triangles, task);
  }
  const Result<std::uint64_t> level = arguments.count("--level", 0, kMostSphereLevel);
  if (!level) return fail(level.error());
  return make_icosphere(static_cast<int>(*level), task);
}

Result<Model> make_sample(const Arguments& arguments, const Task& task) {
  const std::string& name = arguments.inputs.front();
  const Result<std::uint64_t> seed = arguments.count("--seed");
  if (!seed) return fail(seed.error());
  std::size_t triangles = name == "tower" ? kDefaultTowerTriangles : kDefaultTriangles;
  if (arguments.has("--triangles")) {
    const Result<std::uint64_t> wanted = arguments.count("--triangles", 1, kMostSampleTriangles);
    if (!wanted) return fail(wanted.error());
    triangles = *wanted;
  }
  if (name == "sphere") return make_sphere_of(arguments, triangles, task);
  if (arguments.has("--level")) {
    return fail(ErrorCode::bad_argument, fmt::format("{} has no --level", name), {}, "use --triangles N");
  }
  if (name == "statue") return make_statue(triangles, *seed, task);
  if (name == "tower") return make_tower(triangles, task);
  return make_terrain(triangles, *seed, task);
}

}  // namespace

Result<ExitCode> run_sample(const Arguments& arguments, Console& console) {
  SampleReport report;
  report.sample = arguments.inputs.front();
  if (!arguments.has("--output")) {
    return fail(ErrorCode::bad_argument, "sample needs an output", {},
                fmt::format("add one, such as -o {}.glb", report.sample));
  }
  report.file = arguments.text("--output");
  const Result<void> checked = check_output(report.file, {}, io::Compression::none);
  if (!checked) return fail(checked.error());
  Stopwatch watch;
  const Result<Model> model = make_sample(arguments, console.task().part(0.5, "making"));
  if (!model) return fail(model.error());
  if (console.task().cancelled()) return cancelled_error("making the sample");
  const Result<io::WriteReport> written = io::write_model(*model, report.file, {}, console.task().part(0.5, "writing"));
  if (!written) return fail(written.error());
  console.wrote(report.file);
  for (const std::string& warning : written->warnings) console.note(fmt::format("{}: {}", report.file, warning));
  report.triangles = drawn_triangles(*model);
  report.instances = model->instances.size();
  for (const Mesh& mesh : model->meshes) report.vertices += mesh.vertex_count();
  report.bytes = written->total_bytes;
  report.seconds = watch.total();
  arguments.has("--json") ? console.result(to_json(report))
                          : console.table(fmt::format("{}: {} triangles, {}\n", printable(report.file),
                                                      with_separators(report.triangles), human_bytes(report.bytes)));
  return ExitCode::done;
}

}  // namespace lodestone::app
