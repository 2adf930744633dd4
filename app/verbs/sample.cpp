#include <fmt/format.h>

#include "app/input.h"
#include "app/output/json.h"
#include "app/output/text.h"
#include "app/samples/files.h"
#include "app/samples/samples.h"
#include "app/verbs/verbs.h"
#include "lodestone/base/file.h"
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
  LODESTONE_TRY(level);
  return make_icosphere(static_cast<int>(*level), task);
}

Result<Model> make_sample(const Arguments& arguments, const Task& task) {
  const std::string& name = arguments.inputs.front();
  const Result<std::uint64_t> seed = arguments.count("--seed");
  LODESTONE_TRY(seed);
  std::size_t triangles = name == "tower" ? kDefaultTowerTriangles : kDefaultTriangles;
  if (arguments.has("--triangles")) {
    const Result<std::uint64_t> wanted = arguments.count("--triangles", 1, kMostSampleTriangles);
    LODESTONE_TRY(wanted);
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

// Options that this sample doesn't have.
Result<void> check_options(const Arguments& arguments) {
  const std::string& name = arguments.inputs.front();
  const bool is_mesh = name != "ct" && name != "scan";
  for (const char* option : {"--triangles", "--level", "--points"}) {
    const bool fits = std::string_view(option) == "--points" ? name == "scan" : is_mesh;
    if (!arguments.has(option) || fits) continue;
    return fail(ErrorCode::bad_argument, fmt::format("{} has no {}", name, option), {}, "leave it out");
  }
  return {};
}

// ct and scan: bytes of a file with the ending that they need.
Result<ExitCode> run_file_sample(const Arguments& arguments, SampleReport& report, Console& console) {
  const bool is_ct = report.sample == "ct";
  const std::string ending = is_ct ? ".nrrd" : ".ply";
  if (extension_of(report.file) != ending) {
    return fail(ErrorCode::bad_argument, fmt::format("{} is written as {} only", report.sample, ending), report.file,
                fmt::format("end it in {}", ending));
  }
  if (const Result<void> checked = check_place(report.file, {}); !checked) return fail(checked.error());
  const Result<std::uint64_t> seed = arguments.count("--seed");
  LODESTONE_TRY(seed);
  const Result<std::uint64_t> points = arguments.count("--points", 100, kMostSampleTriangles / 2);
  LODESTONE_TRY(points);
  Stopwatch watch;
  const Task making = console.task().part(0.9, "making");
  std::string bytes, what;
  if (is_ct) {
    CtSample ct = make_ct(*seed, making);
    what = fmt::format("{} x {} x {} voxels", ct.size[0], ct.size[1], ct.size[2]);
    report.voxels = ct.size[0] * ct.size[1] * ct.size[2];
    bytes = std::move(ct.nrrd);
  } else {
    ScanSample scan = make_scan(*points, *seed, making);
    what = fmt::format("{} points", with_separators(scan.points));
    report.points = scan.points;
    bytes = std::move(scan.ply);
  }
  if (making.cancelled()) return cancelled_error("making the sample");
  Result<OutputFile> file = OutputFile::create(report.file);
  LODESTONE_TRY(file);
  file->write(bytes);
  LODESTONE_TRY(file->commit());
  console.wrote(report.file);
  report.bytes = bytes.size();
  report.seconds = watch.total();
  arguments.has("--json")
      ? console.result(to_json(report))
      : console.table(fmt::format("{}: {}, {}\n", printable(report.file), what, human_bytes(report.bytes)));
  return ExitCode::done;
}

}  // namespace

Result<ExitCode> run_sample(const Arguments& arguments, Console& console) {
  SampleReport report;
  report.sample = arguments.inputs.front();
  const bool is_file = report.sample == "ct" || report.sample == "scan";
  if (!arguments.has("--output")) {
    const char* ending = report.sample == "ct" ? ".nrrd" : is_file ? ".ply" : ".glb";
    return fail(ErrorCode::bad_argument, "sample needs an output", {},
                fmt::format("add one, such as -o {}{}", report.sample, ending));
  }
  report.file = arguments.text("--output");
  LODESTONE_TRY(check_options(arguments));
  if (is_file) return run_file_sample(arguments, report, console);
  LODESTONE_TRY(check_output(report.file, {}, io::Compression::none));
  Stopwatch watch;
  const Result<Model> model = make_sample(arguments, console.task().part(0.5, "making"));
  LODESTONE_TRY(model);
  if (console.task().cancelled()) return cancelled_error("making the sample");
  const Result<io::WriteReport> written = io::write_model(*model, report.file, {}, console.task().part(0.5, "writing"));
  LODESTONE_TRY(written);
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
