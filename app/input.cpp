#include "app/input.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "app/children/foreign.h"
#include "app/output/json.h"
#include "app/output/text.h"
#include "lodestone/base/file.h"
#include "lodestone/io/content.h"
#include "lodestone/io/gltf/levels.h"
#include "lodestone/io/read.h"
#include "lodestone/io/write.h"

namespace lodestone::app {
namespace fs = std::filesystem;

Result<Model> read_input(const fs::path& path, const Console& console, Task task, const io::ReadOptions& options,
                         const VolumeRequest& volume) {
  std::error_code ignored;
  const bool slices = is_volume(path, volume);
  if (fs::is_directory(path, ignored) && !slices) {
    return fail(ErrorCode::bad_argument, "is a directory, but one file is wanted here", path.string(),
                "name a file in it");
  }
  const auto read = [&]() -> Result<Model> {
    if (slices) return read_volume_model(path, volume, task);
    if (is_scan(path)) return read_scan_model(path, volume, task);
    return io::is_foreign_extension(path.extension().string()) ? read_foreign(path, task)
                                                               : io::read_model(path, options, task);
  };
  Result<Model> model = read();
  if (!model && !volume.read.raw) return fail(io::told_by_content(model.error(), path));
  if (!model) return model;
  LODESTONE_TRY(apply_up(*model, volume.up, path));
  for (const std::string& warning : model->warnings) console.note(fmt::format("{}: {}", path.string(), warning));
  return model;
}

namespace {

// True if both names are the same file, or would be.
bool same_place(const fs::path& a, const fs::path& b) {
  if (same_file(a, b)) return true;
  std::error_code error;
  return fs::weakly_canonical(a, error) == fs::weakly_canonical(b, error);
}

// True if writing to `output` could replace `input`; "{level}" stands for digits.
bool would_overwrite(const fs::path& output, const fs::path& input) {
  const std::string pattern = output.filename().string();
  const std::size_t mark = pattern.find("{level}");
  if (mark == std::string::npos) return same_place(output, input);
  const std::string name = input.filename().string();
  const std::string_view head = std::string_view(pattern).substr(0, mark);
  const std::string_view tail = std::string_view(pattern).substr(mark + std::string_view("{level}").size());
  if (name.size() <= head.size() + tail.size() || !name.starts_with(head) || !name.ends_with(tail)) return false;
  const std::string_view middle = std::string_view(name).substr(head.size(), name.size() - head.size() - tail.size());
  return middle.find_first_not_of("0123456789") == std::string_view::npos &&
         same_place(output.parent_path() / name, input);
}

}  // namespace

bool is_level_pattern(const fs::path& output) {
  return output.filename().string().find("{level}") != std::string::npos;
}

Result<void> check_level(const std::string& input, std::size_t level) {
  if (level == 0) return {};
  if (const auto there = InputFile::open(input); !there) return fail(there.error());
  const std::uint64_t levels = io::levels_in_file(input);
  if (levels == 1) {
    return fail(ErrorCode::bad_argument, "--level is for files with levels (MSFT_lod), this one has none", input,
                "make them with 'lod build'");
  }
  if (level < levels) return {};
  return fail(ErrorCode::bad_argument, fmt::format("has no level {}, its levels are 0 to {}", level, levels - 1),
              input);
}

Result<void> check_output(const fs::path& output, const std::vector<fs::path>& inputs, io::Compression compression,
                          OutputKind kind) {
  const std::string extension = output.extension().string();
  if (!io::is_writable_extension(extension)) {
    return fail(ErrorCode::bad_argument,
                extension.empty() ? "has no extension that names a format"
                                  : fmt::format("'{}' is no format that we write", extension),
                output.string(), "end it in .glb, .gltf, .ply, .obj, .stl or .off");
  }
  LODESTONE_TRY(io::check_model_name(output, compression));
  if (kind == OutputKind::one_model && is_level_pattern(output)) {
    return fail(ErrorCode::bad_argument, "has {level} in its name, but one model is written", output.string(),
                "'lod build' writes a file a level; or leave {level} out");
  }
  return check_place(output, inputs);
}

Result<void> check_place(const fs::path& output, const std::vector<fs::path>& inputs) {
  for (const fs::path& input : inputs) {
    if (would_overwrite(output, input)) {
      return fail(ErrorCode::bad_argument, "is an input, and inputs are never overwritten", output.string(),
                  "choose another name for the output");
    }
  }
  const fs::path folder = output.has_parent_path() ? output.parent_path() : ".";
  std::error_code ignored;
  if (!fs::is_directory(folder, ignored)) {
    return fail(ErrorCode::cannot_write, "its folder does not exist", output.string(), "make the folder first");
  }
  if (fs::is_directory(output, ignored)) {
    return fail(ErrorCode::cannot_write, "is a directory", output.string(), "name a file in it");
  }
  const Result<fs::path> place = output_place(output);
  LODESTONE_TRY(place);
  for (const fs::path& written : {folder, place->has_parent_path() ? place->parent_path() : fs::path(".")}) {
    if (::access(written.c_str(), W_OK) == 0) continue;
    return fail(ErrorCode::cannot_write, std::generic_category().message(errno), written.string(),
                "choose a folder that you may write to");
  }
  return {};
}

tl::unexpected<Error> missing_output(const std::string& verb, const std::string& input) {
  const std::string stem = fs::path(input).stem().string();
  return fail(ErrorCode::bad_argument, fmt::format("{} needs an output", verb), {},
              fmt::format("add one, such as -o {}_{}.glb", stem, verb == "build" ? "lod" : verb));
}

std::string forgotten_output(const Arguments& arguments) {
  if (arguments.has("--output") || arguments.inputs.size() < 2) return {};
  const std::string& last = arguments.inputs.back();
  std::error_code ignored;
  return fs::exists(last, ignored) ? std::string() : fmt::format("to write {}, use -o {}", last, last);
}

Result<std::vector<fs::path>> models_in(const fs::path& directory) {
  std::error_code error;
  std::vector<fs::path> files;
  for (fs::directory_iterator entry(directory, error), end; !error && entry != end; entry.increment(error)) {
    std::error_code ignored;
    if (entry->is_regular_file(ignored) && io::is_model_extension(entry->path().extension().string())) {
      files.push_back(entry->path());
    }
  }
  if (error) return fail(ErrorCode::cannot_read, error.message(), directory.string());
  if (files.empty()) {
    return fail(ErrorCode::empty, "has no file of a format that we read", directory.string(),
                fmt::format("known are {}", fmt::join(io::readable_extensions(), " ")));
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::uint64_t peak_memory_bytes() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

}  // namespace lodestone::app
