#include "app/foreign.h"

#include <fcntl.h>
#include <fmt/format.h>

#include <cstdlib>
#include <new>
#include <sstream>
#include <utility>

#include "app/child_process.h"
#include "lodestone/base/file.h"
#include "lodestone/io/read.h"
#include "lodestone/io/write.h"

namespace lodestone::app {
namespace fs = std::filesystem;
namespace {

constexpr const char* kConvertFirst = "convert it to glTF, OBJ or PLY with the program that made it";

struct ChildReport {
  bool done = false, failed = false;
  double meters_per_unit = 0;
  std::uint64_t vertices = 0, triangles = 0;
  std::vector<std::string> warnings;
  Error error;
};

ChildReport parse_report(const std::string& text) {
  ChildReport report;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t space = std::min(line.find(' '), line.size());
    const std::string key = line.substr(0, space);
    const std::string value = line.substr(std::min(space + 1, line.size()));
    if (key == "unit") report.meters_per_unit = std::strtod(value.c_str(), nullptr);
    if (key == "vertices") report.vertices = std::strtoull(value.c_str(), nullptr, 10);
    if (key == "triangles") report.triangles = std::strtoull(value.c_str(), nullptr, 10);
    if (key == "warning") report.warnings.push_back(value);
    if (key == "code") report.error.code = static_cast<ErrorCode>(std::atoi(value.c_str()));
    if (key == "what") report.error.what = value;
    if (key == "where") report.error.where = value;
    if (key == "remedy") report.error.remedy = value;
    if (key == "done") report.done = true;
    if (key == "failed") report.failed = true;
  }
  return report;
}

}  // namespace

Result<Model> read_foreign(const fs::path& path, Task task) {
  const Result<InputFile> file = InputFile::open(path);
  if (!file) return fail(file.error());
  const TemporaryFolder folder;
  if (folder.path().empty()) {
    return fail(ErrorCode::cannot_write, "no temporary folder could be made", path.string(), "set TMPDIR to one");
  }
  const fs::path glb = folder.path() / "model.glb";
  const ChildLimits limits = limits_for(file->size());
  const Result<ChildOutcome> outcome =
      run_child("/proc/self/exe", {"lod", kForeignVerb, path.string(), glb.string()}, limits, task);
  if (!outcome) return fail(outcome.error());
  if (outcome->end == ChildOutcome::End::cancelled) return cancelled_error("reading");
  ChildReport report = parse_report(outcome->report);
  if (report.failed) return fail(std::move(report.error));
  if (!report.done || outcome->status != 0) {
    return fail(ErrorCode::bad_format, ending_of(*outcome, limits), path.string(), kConvertFirst);
  }

  Result<Model> model = io::read_model(glb, {}, task);
  if (!model) return model;
  model->files = {path};
  model->meters_per_unit = report.meters_per_unit;
  model->file_vertices = report.vertices;
  model->file_triangles = report.triangles;
  model->warnings = std::move(report.warnings);
  return model;
}

int foreign_main(const std::vector<std::string>& words) {
  if (words.size() != 2 || ::fcntl(kReportDescriptor, F_GETFD) < 0) return 2;
  Error error;
  try {
    Result<Model> model = io::read_model(words[0]);
    // The unit goes its own way: a written one would scale the scene.
    const double meters_per_unit = model ? std::exchange(model->meters_per_unit, 0) : 0;
    const Result<io::WriteReport> written =
        model ? io::write_model(*model, words[1]) : Result<io::WriteReport>(fail(model.error()));
    if (written) {
      report_line("unit", fmt::format("{}", meters_per_unit));
      report_line("vertices", fmt::format("{}", model->file_vertices));
      report_line("triangles", fmt::format("{}", model->file_triangles));
      for (const std::string& warning : model->warnings) report_line("warning", warning);
      report_line("done", "");
      return 0;
    }
    error = written.error();
  } catch (const std::bad_alloc&) {
    error = Error{ErrorCode::out_of_memory, "reading it needs more memory than it may take", words[0], kConvertFirst};
  }
  report_line("code", fmt::format("{}", static_cast<int>(error.code)));
  report_line("what", error.what);
  report_line("where", error.where);
  report_line("remedy", error.remedy);
  report_line("failed", "");
  return 1;
}

}  // namespace lodestone::app
