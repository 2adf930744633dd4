#include "app/verbs/build_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <system_error>

#include "app/input.h"
#include "app/options/constraints.h"
#include "app/output/text.h"
#include "app/verbs/build_report.h"
#include "lodestone/base/file.h"
#include "lodestone/base/units.h"

namespace lodestone::app {
namespace fs = std::filesystem;
namespace {

Result<void> read_target(const Arguments& arguments, BuildPlan& plan) {
  const Result<std::string> target =
      given_target(arguments, {"--levels", "--ratio", "--triangles", "--error", "--distances"},
                   "choose one; --ratio, --triangles, --error and --distances take a list, one level for each value");
  LODESTONE_TRY(target);
  if (arguments.has("--pixels") && *target != "--distances") {
    return fail(ErrorCode::bad_argument, "--pixels needs --distances", {}, "such as --pixels 1 --distances 5,10,20");
  }
  // Takes a parsed value over, or hands its error on.
  const auto take = [](auto parsed, auto& into) -> Result<void> {
    LODESTONE_TRY(parsed);
    into = std::move(*parsed);
    return {};
  };
  if (*target == "--ratio") return take(ratio_list(arguments, "--ratio"), plan.ratios);
  if (*target == "--triangles") return take(arguments.count_list("--triangles"), plan.triangles);
  if (*target == "--error") return take(length_list(arguments, "--error", plan.lengths), plan.errors);
  if (*target == "--distances") {
    LODESTONE_TRY(take(arguments.positive("--pixels"), plan.pixels));
    return take(length_list(arguments, "--distances", plan.lengths, BareLength::model_units), plan.distances);
  }
  return take(arguments.count("--levels", 2, kMostLevels), plan.levels);
}

}  // namespace

Result<BuildPlan> build_plan(const Arguments& arguments) {
  BuildPlan plan;
  const Result<LengthRules> lengths = length_rules(arguments);
  LODESTONE_TRY(lengths);
  plan.lengths = *lengths;
  LODESTONE_TRY(read_target(arguments, plan));
  const Result<measure::View> view = view_of(arguments);
  LODESTONE_TRY(view);
  plan.view = *view;
  const Result<measure::DistanceOptions> distance = distance_options(arguments);
  LODESTONE_TRY(distance);
  plan.distance = *distance;
  Result<ConstraintPlan> constraints = constraints_of(arguments, plan.lengths);
  LODESTONE_TRY(constraints);
  plan.constraints = std::move(*constraints);
  Result<VolumeRequest> volume = volume_request(arguments);
  LODESTONE_TRY(volume);
  plan.volume = std::move(*volume);
  const Result<std::optional<chain::VoxelLadderOptions>> voxel = voxel_method(arguments);
  LODESTONE_TRY(voxel);
  plan.voxel = *voxel;
  plan.effort = effort_of(arguments, chain::Effort::normal);
  if (plan.voxel && arguments.has("--effort")) {
    return fail(ErrorCode::bad_argument, "--effort is for levels by edge collapse", {}, "leave out --method voxel");
  }
  plan.compression = compression_of(arguments);
  plan.force = arguments.has("--force");
  plan.verify = arguments.has("--verify");
  plan.image_error = arguments.has("--image-error");
  plan.report = arguments.has("--report");
  plan.options = report_options(arguments);
  return plan;
}

std::size_t planned_levels(const BuildPlan& plan) {
  if (plan.levels > 0) return plan.levels;
  return 1 + std::max({plan.ratios.size(), plan.triangles.size(), plan.errors.size(), plan.distances.size()});
}

namespace {

// Triangles of the coarsest level that is asked for; 0 where an error decides, and levels by voxels have no parts to
// lose.
std::size_t smallest_level(const BuildPlan& plan, const Model& model) {
  if (plan.voxel) return std::numeric_limits<std::size_t>::max();
  if (!plan.triangles.empty()) return plan.triangles.back();
  const auto drawn = static_cast<double>(drawn_triangles(model));
  if (!plan.ratios.empty()) return static_cast<std::size_t>(plan.ratios.back() * drawn);
  if (!plan.errors.empty() || !plan.distances.empty()) return 0;
  return static_cast<std::size_t>(drawn /
                                  static_cast<double>(std::uint64_t{1} << (std::max<std::size_t>(1, plan.levels) - 1)));
}

}  // namespace

Result<chain::LadderOptions> ladder_options(const BuildPlan& plan, const Model& model, std::vector<std::string>& notes,
                                            std::vector<std::string>& warnings, const Task& task) {
  chain::LadderOptions options;
  if (plan.levels > 0) options.levels = plan.levels;
  options.ratios = plan.ratios;
  options.triangles = plan.triangles;
  Result<chain::SimplifyConstraints> constraints =
      plan.constraints.for_model(model, smallest_level(plan, model), warnings, task);
  LODESTONE_TRY(constraints);
  options.constraints = std::move(*constraints);
  options.effort = plan.voxel ? chain::Effort::fast : plan.effort;
  options.force = plan.force;
  options.distance = plan.distance;
  if (plan.image_error) options.image.emplace();
  if (!plan.ratios.empty()) {
    std::vector<std::string> shares;
    for (const double ratio : plan.ratios) shares.push_back(percent(ratio));
    notes.push_back(
        fmt::format("keeping {} of {} triangles", fmt::join(shares, ", "), with_separators(drawn_triangles(model))));
  }
  const double diagonal = bounds_of(model).diagonal();
  const Result<std::vector<double>> errors = to_model_units(plan.errors, model, diagonal);
  LODESTONE_TRY(errors);
  options.errors = *errors;
  doubt_lengths("--error", plan.errors, model, warnings);
  const Result<std::vector<double>> distances = to_model_units(plan.distances, model, diagonal);
  LODESTONE_TRY(distances);
  for (const double distance : *distances) {
    options.errors.push_back(measure::pixels_to_error(plan.pixels, distance, plan.view));
    notes.push_back(fmt::format("{} pixels at {} allow an error of {} ({} of the diagonal)", plan.pixels,
                                short_number(distance), short_number(options.errors.back()),
                                percent(diagonal > 0 ? options.errors.back() / diagonal : 0)));
  }
  return options;
}

namespace {

bool is_folder(const fs::path& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored);
}

std::string replaced(std::string text, std::string_view mark, const std::string& by) {
  for (std::size_t at = text.find(mark); at != std::string::npos; at = text.find(mark, at + by.size())) {
    text.replace(at, mark.size(), by);
  }
  return text;
}

// A folder that is a batch of models, not one volume.
bool is_batch(const fs::path& path, const VolumeRequest& volume) { return is_folder(path) && !is_volume(path, volume); }

// Inputs with directories replaced by their files.
Result<std::vector<fs::path>> list_inputs(const Arguments& arguments, const VolumeRequest& volume) {
  std::vector<fs::path> inputs;
  for (const std::string& word : arguments.inputs) {
    if (!is_batch(word, volume)) {
      inputs.emplace_back(word);
      continue;
    }
    Result<std::vector<fs::path>> files = models_in(word);
    LODESTONE_TRY(files);
    inputs.insert(inputs.end(), files->begin(), files->end());
  }
  return inputs;
}

// "scan" for scan.ply, scan.nii.gz and the folder scan/.
std::string stem_of(const fs::path& input) {
  const fs::path named = input.has_filename() ? input : input.parent_path();
  const std::string stem = named.stem().string();
  return extension_of(named) == ".gz" ? fs::path(stem).stem().string() : stem;
}

// Two inputs a.ply and a.obj would both become a.glb: those keep their endings.
std::vector<std::string> output_names(const std::vector<fs::path>& inputs) {
  std::map<std::string, int> uses;
  for (const fs::path& input : inputs) ++uses[stem_of(input)];
  std::vector<std::string> names;
  for (const fs::path& input : inputs) {
    const std::string stem = stem_of(input);
    names.push_back(uses[stem] > 1 ? input.filename().string() : stem);
  }
  return names;
}

// Of the outputs, or of the reports. A report never has the name of a model, as its ending is another.
Result<void> check_distinct(const std::vector<BuildJob>& jobs, fs::path BuildJob::*place) {
  std::map<fs::path, fs::path> owner;
  for (const BuildJob& job : jobs) {
    if ((job.*place).empty()) continue;
    const auto [found, fresh] = owner.emplace((job.*place).lexically_normal(), job.input);
    if (fresh) continue;
    return fail(ErrorCode::bad_argument,
                fmt::format("both {} and {} would be written there", found->second.string(), job.input.string()),
                (job.*place).string(), "put {name} into it, or build them apart");
  }
  return {};
}

// Before a folder exists only the names can be checked.
Result<void> check_outputs(const BuildJobs& all, const std::vector<fs::path>& inputs, io::Compression compression) {
  for (const auto place : {&BuildJob::output, &BuildJob::report}) {
    LODESTONE_TRY(check_distinct(all.jobs, place));
  }
  const bool folder_exists = all.folder.empty() || is_folder(all.folder);
  for (const BuildJob& job : all.jobs) {
    Result<void> checked = check_output(job.output, inputs, compression, OutputKind::levels);
    if (checked) checked = io::check_ladder_name(job.output, compression);
    if (!checked && (folder_exists || checked.error().code == ErrorCode::bad_argument)) return checked;
    if (job.report.empty()) continue;
    checked = check_place(job.report, inputs);
    const bool in_folder = !folder_exists && job.report.parent_path() == job.output.parent_path();
    if (!checked && (!in_folder || checked.error().code == ErrorCode::bad_argument)) return checked;
  }
  return {};
}

// Empty without --report.
Result<std::string> report_pattern(const Arguments& arguments, bool batch) {
  if (!arguments.has("--report")) return std::string();
  std::string report = arguments.text("--report");
  const std::string ending = extension_of(report);
  if (ending != ".html" && ending != ".htm") {
    return fail(ErrorCode::bad_argument, "--report is a page, its name must end in .html", report);
  }
  if (batch && report.find("{name}") == std::string::npos) {
    return fail(ErrorCode::bad_argument, fmt::format("--report {} is one page, but there are several inputs", report),
                {}, "put {name} into it, such as --report '{name}.html'");
  }
  return report;
}

}  // namespace

Result<BuildJobs> build_jobs(const Arguments& arguments, const VolumeRequest& volume) {
  if (const std::string remedy = forgotten_output(arguments); !remedy.empty()) {
    return fail(ErrorCode::bad_argument, "build needs an output", {}, remedy);
  }
  if (!arguments.has("--output")) return missing_output("build", arguments.inputs.front());
  const std::string output = arguments.text("--output");
  const bool into_folder = output.ends_with('/') || is_folder(output);
  BuildJobs all;
  all.batch = arguments.inputs.size() > 1 || is_batch(arguments.inputs.front(), volume);
  if (all.batch && !into_folder && output.find("{name}") == std::string::npos) {
    return fail(ErrorCode::bad_argument, fmt::format("-o {} is one file, but there are several inputs", output), {},
                "name a folder with a slash at its end, such as -o lods/");
  }
  Result<std::vector<fs::path>> inputs = list_inputs(arguments, volume);
  LODESTONE_TRY(inputs);
  if (into_folder) all.folder = output;
  for (const std::string& word : arguments.inputs) {
    if (into_folder && is_folder(word) && same_file(word, output)) {
      return fail(ErrorCode::bad_argument, "is the folder of the inputs, whose results would be inputs the next time",
                  output, "name another folder for -o");
    }
  }
  const Result<std::string> report = report_pattern(arguments, all.batch);
  LODESTONE_TRY(report);
  const std::string pattern = into_folder ? (fs::path(output) / "{name}.glb").string() : output;
  const std::vector<std::string> names = output_names(*inputs);
  for (std::size_t i = 0; i < inputs->size(); ++i) {
    all.jobs.push_back(
        BuildJob{(*inputs)[i], replaced(pattern, "{name}", names[i]), replaced(*report, "{name}", names[i])});
  }
  LODESTONE_TRY(check_outputs(all, *inputs, compression_of(arguments)));
  return all;
}

}  // namespace lodestone::app
