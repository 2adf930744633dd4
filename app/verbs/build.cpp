#include <fmt/format.h>

#include <algorithm>
#include <new>
#include <optional>
#include <system_error>
#include <utility>

#include "app/input.h"
#include "app/options/surface_attributes.h"
#include "app/output/json.h"
#include "app/output/setting_names.h"
#include "app/output/table.h"
#include "app/output/text.h"
#include "app/verbs/build_plan.h"
#include "app/verbs/build_report.h"
#include "app/verbs/verbs.h"
#include "app/verbs/verify.h"
#include "lodestone/base/stopwatch.h"
#include "lodestone/base/units.h"
#include "lodestone/core/flatten.h"
#include "lodestone/io/images/decode.h"

namespace lodestone::app {
namespace fs = std::filesystem;
namespace {

void add_levels(BuildReport& report, const chain::LadderResult& result, const io::WriteReport& written,
                const measure::View& view) {
  const Ladder& ladder = result.ladder;
  for (std::size_t i = 0; i < ladder.levels.size(); ++i) {
    const Level& level = ladder.levels[i];
    LevelReport row;
    row.level = i;
    row.triangles = level.triangles;
    if (report.prunes) row.vanished_parts = level.vanished_parts;
    row.error = level.error;
    row.method = level.method;
    if (!result.images.empty()) row.image = result.images[i];
    row.switch_distance = measure::switch_distance(level.error.error, 1, view);
    row.bytes = written.level_bytes[i];
    row.file = written.files[i].string();
    row.seconds = level.seconds;
    report.levels.push_back(std::move(row));
  }
  report.total_bytes = written.total_bytes;
}

// Reads the input and begins the report; nothing that belongs to the input may be replaced.
Result<Model> read_job(const BuildJob& job, const BuildPlan& plan, BuildReport& report, const Console& console,
                       const Task& task) {
  report.input = job.input.string();
  Result<Model> model = read_input(job.input, console, task, {.levels = false}, plan.volume);
  if (!model) return model;
  Result<void> kept = io::check_replaced(*model, job.output, planned_levels(plan));
  if (kept && !job.report.empty()) kept = io::check_replaced(*model, job.report);
  LODESTONE_TRY(kept);
  apply_unit(*model, plan.lengths);
  report.triangles = drawn_triangles(*model);
  report.diagonal = bounds_of(*model).diagonal();
  report.unit = unit_name(model->meters_per_unit);
  report.warnings = model->warnings;
  return model;
}

// What was asked, for this model, and its textures where pictures are drawn. What a user should know is told.
Result<chain::LadderOptions> prepare_job(const BuildPlan& plan, Model& model, BuildReport& report,
                                         std::vector<std::string>& warnings, const Console& console, const Task& task) {
  std::vector<std::string> notes;
  Result<chain::LadderOptions> options = ladder_options(plan, model, notes, warnings, task);
  if (!options) return options;
  if (plan.image_error || plan.report) {
    LODESTONE_TRY(io::decode_base_colors(model, warnings, task));
  }
  report.prunes = options->constraints.vanishes();
  report.warnings.insert(report.warnings.end(), warnings.begin(), warnings.end());
  notes.insert(notes.end(), warnings.begin(), warnings.end());
  for (const std::string& note : notes) console.note(fmt::format("{}: {}", report.input, note));
  return options;
}

// By voxels the original is one mesh, as each level is.
Result<chain::LadderResult> make_levels(Model model, const BuildPlan& plan, const chain::LadderOptions& options,
                                        bool one_file, BuildReport& report, const Console& console, const Task& task) {
  if (!plan.voxel) return chain::build_ladder(std::move(model), options, task);
  std::vector<std::string> warnings;
  Model one = flattened(std::move(model), warnings);
  LODESTONE_TRY(decode_for(plan.voxel->attributes, one, warnings, task.part(0.1)));
  Result<chain::LadderResult> result = chain::build_voxel_ladder(std::move(one), options, *plan.voxel, task.part(0.9));
  if (!result) return result;
  warnings.insert(warnings.end(), result->warnings.begin(), result->warnings.end());
  if (one_file) share_materials(result->ladder);
  report.warnings.insert(report.warnings.end(), warnings.begin(), warnings.end());
  for (const std::string& warning : warnings) console.note(fmt::format("{}: {}", report.input, warning));
  return result;
}

// Levels first, then the page that tells of them.
Result<void> write_job(const BuildJob& job, const BuildPlan& plan, const chain::LadderResult& result,
                       std::optional<ReportPage>& page, BuildReport& report, Console& console, const Task& task) {
  const io::WriteOptions write{plan.compression, chain::screen_coverages(result.ladder, plan.view)};
  const Result<io::WriteReport> written = io::write_ladder(result.ladder, job.output, write, task);
  LODESTONE_TRY(written);
  for (const fs::path& file : written->files) console.wrote(file.string());
  add_levels(report, result, *written, plan.view);
  for (const std::string& warning : written->warnings) {
    console.note(fmt::format("{}: {}", job.output.string(), warning));
    report.warnings.push_back(warning);
  }
  if (!page) return {};
  if (const Result<void> done = page->finish(*written); !done) {
    Error error = done.error();
    error.remedy = "the levels are written, the page is not";
    return fail(std::move(error));
  }
  console.wrote(job.report.string());
  report.report = job.report.string();
  return {};
}

Result<BuildReport> build_one(const BuildJob& job, const BuildPlan& plan, Console& console, const Task& task) {
  Stopwatch watch;
  BuildReport report;
  std::vector<std::string> warnings;  // on top of the model's own
  Result<Model> model = read_job(job, plan, report, console, task.part(0.05, "reading"));
  LODESTONE_TRY(model);
  report.read_seconds = watch.lap();
  const Result<chain::LadderOptions> options = prepare_job(plan, *model, report, warnings, console, task);
  LODESTONE_TRY(options);
  const bool one_file = job.output.filename().string().find("{level}") == std::string::npos;
  const Result<chain::LadderResult> result = make_levels(std::move(*model), plan, *options, one_file, report, console,
                                                         task.part(plan.report ? 0.7 : 0.9, "making levels"));
  LODESTONE_TRY(result);
  report.levels_seconds = result->simplify_seconds;
  report.measure_seconds = result->measure_seconds;
  report.shortfalls = result->shortfalls;

  std::optional<ReportPage> page;  // drawn before anything is written, so that an interrupted run leaves nothing
  if (plan.report) {
    Result<ReportPage> drawn = ReportPage::draw(job, plan, *result, warnings, task.part(0.2, "drawing"));
    LODESTONE_TRY(drawn);
    page.emplace(std::move(*drawn));
  }
  watch.lap();
  const Result<void> written = write_job(job, plan, *result, page, report, console, task.part(0.05, "writing"));
  LODESTONE_TRY(written);
  report.write_seconds = watch.lap();
  if (plan.verify) {
    const Result<VerifyReport> verified =
        verify_levels(report, plan.distance, task.part(0.3, "reading back what was written"));
    LODESTONE_TRY(verified);
    report.verified = *verified;
  }
  report.total_seconds = watch.total();
  report.peak_memory_bytes = peak_memory_bytes();
  return report;
}

// One file too large must not end a batch.
Result<BuildReport> build_within_memory(const BuildJob& job, const BuildPlan& plan, Console& console,
                                        const Task& task) {
  try {
    return build_one(job, plan, console, task);
  } catch (const std::bad_alloc&) {
    return fail(ErrorCode::out_of_memory, "out of memory", job.input.string(),
                "use a machine with more, or a smaller model");
  }
}

void add_cells(std::vector<std::string>& row, const measure::ImageDeviation& image) {
  row.push_back(percent(image.silhouette_mean));
  row.push_back(fmt::format("{:.1f} dB", image.worse_psnr()));
  row.push_back(fmt::format("{:.4f}", image.worse_ssim()));
}

std::string table_of(const BuildReport& report, const BuildPlan& plan) {
  const std::string unit = report.unit.empty() ? "" : " (" + report.unit + ")";
  Table table;
  for (const char* title : {"level", "triangles", "share"}) table.add_column(title);
  if (report.prunes) table.add_column("parts gone");
  table.add_column("error" + unit);
  table.add_column("relative");
  table.add_column("1 px from" + unit);
  const bool pictures = report.levels.front().image.has_value();
  if (pictures) {
    for (const char* title : {"silhouette", "PSNR", "SSIM"}) table.add_column(title);
  }
  for (const char* title : {"bytes", "seconds"}) table.add_column(title);
  bool all_certain = true;
  for (const LevelReport& level : report.levels) {
    const double share =
        static_cast<double>(level.triangles) / static_cast<double>(std::max<std::size_t>(1, report.triangles));
    std::vector<std::string> row{fmt::format("{}", level.level), with_separators(level.triangles), percent(share)};
    if (level.vanished_parts) row.push_back(with_separators(*level.vanished_parts));
    const bool certain = level.error.kind == ErrorKind::bounded;
    all_certain = all_certain && certain;
    for (const std::string& cell :
         {(certain ? "" : "~") + short_number(level.error.error), percent(level.error.relative(level.error.error)),
          short_number(level.switch_distance)}) {
      row.push_back(cell);
    }
    if (level.image) add_cells(row, *level.image);
    row.push_back(human_bytes(level.bytes));
    row.push_back(seconds_text(level.seconds));
    table.add_row(std::move(row));
  }
  std::string out =
      fmt::format("{} -> {}\n{}", printable(report.input), printable(report.levels.back().file), table.text());
  if (report.levels.front().file != report.levels.back().file) {
    out = fmt::format("{} -> {} ... {}\n{}", printable(report.input), printable(report.levels.front().file),
                      printable(report.levels.back().file), table.text());
  }
  if (report.levels.size() > 1) {
    out += all_certain ? "errors are certified: no point of either surface is farther from the other\n"
                       : "errors are certified, but for those with ~: the largest that was found\n";
  }
  if (report.verified) {
    out += fmt::format("read back from what was written and measured again: all as told, within {} of each error\n",
                       percent(report.verified->largest_difference));
  }
  if (pictures) {
    out += fmt::format("silhouette, PSNR, SSIM: pictures from {} sides compared with the original's\n",
                       report.levels.front().image->views);
  }
  return out + fmt::format(
                   "{} in all, {} s; 1 px from: the distance from which the error is at most a pixel ({} lines, {} "
                   "degrees)\n",
                   human_bytes(report.total_bytes), seconds_text(report.total_seconds), plan.view.height_px,
                   plan.view.fov_degrees);
}

void tell_shortfalls(const BuildReport& report, const Console& console) {
  for (const chain::Shortfall& shortfall : report.shortfalls) {
    console.shortfall(fmt::format("{}: level {}: {}", report.input, shortfall.level, shortfall.reason));
  }
}

// A folder made for the results, taken away again if nothing came into it.
class ResultFolder {
 public:
  Result<void> make(const fs::path& path) {
    if (path.empty()) return {};
    std::error_code error;
    const bool made = fs::create_directory(path.has_filename() ? path : path.parent_path(), error);
    if (error) {
      return fail(ErrorCode::cannot_write, error.message(), path.string(), "make its parent folder first");
    }
    if (made) path_ = path;
    return {};
  }
  ResultFolder() = default;
  ResultFolder(const ResultFolder&) = delete;
  ResultFolder& operator=(const ResultFolder&) = delete;
  ~ResultFolder() {
    std::error_code ignored;
    if (!path_.empty()) fs::remove(path_.has_filename() ? path_ : path_.parent_path(), ignored);  // only if empty
  }

 private:
  fs::path path_;
};

Result<ExitCode> run_single(const BuildJob& job, const BuildPlan& plan, bool json, Console& console) {
  const Result<BuildReport> report = build_one(job, plan, console, console.task().part(1.0));
  LODESTONE_TRY(report);
  json ? console.result(to_json(*report)) : console.table(table_of(*report, plan));
  tell_shortfalls(*report, console);
  return report->shortfalls.empty() ? ExitCode::done : ExitCode::fell_short;
}

// Goes on after a bad file; only a cancelled one ends the batch.
Result<ExitCode> run_batch(const std::vector<BuildJob>& jobs, const BuildPlan& plan, bool json, Console& console) {
  std::vector<BuildReport> runs;
  std::vector<Error> failures;
  bool fell_short = false;
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    console.set_title(fmt::format("{} of {}, {}", i + 1, jobs.size(), jobs[i].input.filename().string()));
    const Task task = console.task().part(1.0 / static_cast<double>(jobs.size()));
    Result<BuildReport> report = build_within_memory(jobs[i], plan, console, task);
    if (!report && report.error().code == ErrorCode::cancelled) return fail(report.error());
    if (!report) {
      console.error(report.error());
      BuildReport failed;
      failed.input = jobs[i].input.string();
      failed.failure = with_options(report.error()).line();
      runs.push_back(std::move(failed));
      failures.push_back(report.error());
      continue;
    }
    if (!json) console.table((i > 0 ? "\n" : "") + table_of(*report, plan));
    tell_shortfalls(*report, console);
    fell_short = fell_short || !report->shortfalls.empty();
    runs.push_back(std::move(*report));
  }
  if (json) console.result(to_json(runs));
  if (failures.empty()) return fell_short ? ExitCode::fell_short : ExitCode::done;
  std::vector<std::string> names;
  for (const BuildReport& run : runs) {
    if (!run.failure.empty()) names.push_back(run.input);
  }
  console.shortfall(fmt::format("{} of {} failed: {}", failures.size(), jobs.size(), fmt::join(names, ", ")));
  return ExitCode::failed;
}

}  // namespace

Result<ExitCode> run_build(const Arguments& arguments, Console& console) {
  const Result<BuildPlan> plan = build_plan(arguments);
  LODESTONE_TRY(plan);
  const Result<BuildJobs> all = build_jobs(arguments, plan->volume);
  LODESTONE_TRY(all);
  ResultFolder folder;
  LODESTONE_TRY(folder.make(all->folder));
  const bool json = arguments.has("--json");
  return all->batch ? run_batch(all->jobs, *plan, json, console) : run_single(all->jobs.front(), *plan, json, console);
}

}  // namespace lodestone::app
