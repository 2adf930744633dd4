#include "app/children/foreign.h"

#include <fcntl.h>
#include <fmt/format.h>

#include <new>
#include <utility>

#include "app/children/child_process.h"
#include "lodestone/base/file.h"
#include "lodestone/io/read.h"
#include "lodestone/io/write.h"

namespace lodestone::app {
namespace fs = std::filesystem;
namespace {

constexpr const char* kConvertFirst = "convert it to glTF, OBJ or PLY with the program that made it";

}  // namespace

Result<Model> read_foreign(const fs::path& path, Task task) {
  const Result<InputFile> file = InputFile::open(path);
  LODESTONE_TRY(file);
  const TemporaryFolder folder;
  if (folder.path().empty()) {
    return fail(ErrorCode::cannot_write, "no temporary folder could be made", path.string(), "set TMPDIR to one");
  }
  const fs::path glb = folder.path() / "model.glb";
  const ChildLimits limits = limits_for(file->size());
  const Result<ChildOutcome> outcome =
      run_child("/proc/self/exe", {"lod", kForeignVerb, path.string(), glb.string()}, limits, task);
  LODESTONE_TRY(outcome);
  if (outcome->end == ChildOutcome::End::cancelled) return cancelled_error("reading");
  const ChildReport& report = outcome->report;
  if (report.failed) return fail(report.error);
  if (!report.done || outcome->status != 0) {
    return fail(ErrorCode::bad_format, ending_of(*outcome, limits), path.string(), kConvertFirst);
  }

  Result<Model> model = io::read_model(glb, {}, task);
  if (!model) return model;
  model->files = {path};
  model->meters_per_unit = report.number("unit");
  model->file_vertices = static_cast<std::uint64_t>(report.number("vertices"));
  model->file_triangles = static_cast<std::uint64_t>(report.number("triangles"));
  model->warnings = report.values("warning");
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
      say("unit", fmt::format("{}", meters_per_unit));
      say("vertices", fmt::format("{}", model->file_vertices));
      say("triangles", fmt::format("{}", model->file_triangles));
      for (const std::string& warning : model->warnings) say("warning", warning);
      say_done();
      return 0;
    }
    error = written.error();
  } catch (const std::bad_alloc&) {
    error = Error{ErrorCode::out_of_memory, "reading it needs more memory than it may take", words[0], kConvertFirst};
  }
  say_failed(error);
  return 1;
}

}  // namespace lodestone::app
