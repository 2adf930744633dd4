// Which writer a name asks for, and how files that belong together get into their places.
#include "lodestone/io/write.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <set>
#include <system_error>
#include <utility>

#include "lodestone/base/file.h"
#include "lodestone/base/text.h"
#include "lodestone/core/validate.h"
#include "lodestone/io/gltf/write.h"
#include "lodestone/io/plain/obj_write.h"
#include "lodestone/io/plain/off_write.h"
#include "lodestone/io/plain/ply_write.h"
#include "lodestone/io/plain/stl_write.h"
#include "lodestone/io/shown_colors_detail.h"
#include "lodestone/io/text_reader_detail.h"

namespace lodestone::io {
namespace fs = std::filesystem;

namespace {

constexpr std::string_view kLevelMark = "{level}";
constexpr std::array<std::string_view, 6> kExtensions{".glb", ".gltf", ".ply", ".obj", ".stl", ".off"};

bool is_gltf(std::string_view extension) { return extension == ".glb" || extension == ".gltf"; }

bool is_pattern(const fs::path& path) { return path.filename().string().find(kLevelMark) != std::string::npos; }

// The file of one level; a name without the mark stands for all.
fs::path level_file(const fs::path& pattern, std::size_t level) {
  std::string name = pattern.filename().string();
  const std::size_t mark = name.find(kLevelMark);
  if (mark == std::string::npos) return pattern;
  return pattern.parent_path() / name.replace(mark, kLevelMark.size(), std::to_string(level));
}

bool is_there(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(fs::symlink_status(path, ignored));
}

// ---- side files ----

// The .bin of a .gltf or the .mtl of an .obj; empty for other formats.
fs::path companion_of(const fs::path& path) {
  const std::string e = extension_of(path);
  if (e == ".gltf") return fs::path(path).replace_extension(".bin");
  if (e == ".obj") return fs::path(path).replace_extension(".mtl");
  return {};
}

bool has_textures(const Model& model) {
  return std::any_of(model.materials.begin(), model.materials.end(), [](const Material& m) {
    return m.base_color_texture != nullptr && !m.base_color_texture->encoded.empty();
  });
}

// True if the model becomes more than one file.
bool has_side_files(const Model& model, std::string_view extension) {
  return extension == ".gltf" || (extension == ".obj" && !model.materials.empty()) ||
         (extension == ".ply" && has_textures(model));
}

tl::unexpected<Error> not_replaced(const fs::path& target, std::string what, std::string remedy) {
  return fail(ErrorCode::cannot_write, std::move(what), target.string(), std::move(remedy));
}

// Whether `target` may be written as a part of the output `path`.
Result<void> check_target(const Model& input, const fs::path& target, const fs::path& path) {
  std::error_code ignored;
  if (!is_there(target)) return {};
  if (fs::is_directory(target, ignored)) {
    return not_replaced(target, "is a directory", "move it away, or choose another output name or folder");
  }
  if (const Result<fs::path> place = output_place(target); !place) return fail(place.error());
  for (const fs::path& file : input.files) {
    if (!same_file(file, target)) continue;
    return not_replaced(target, fmt::format("belongs to the input, and writing {} would replace it", path.string()),
                        "choose another output name or folder");
  }
  // Beside the output of an earlier run it is that run's; alone it is somebody else's.
  if (target == path || is_there(path)) return {};
  return not_replaced(target,
                      fmt::format("is there already without the {} that it would belong to", path.filename().string()),
                      "choose another output name or folder, or move it away");
}

bool same_bytes(const fs::path& a, const fs::path& b) {
  std::error_code error;
  if (fs::file_size(a, error) != fs::file_size(b, error) || error) return false;
  const Result<std::string> bytes_a = read_file(a), bytes_b = read_file(b);
  return bytes_a && bytes_b && *bytes_a == *bytes_b;
}

// Textures are named by the model, not by the user, so they replace nothing: where a file of their name lies in the
// folder it must be the same picture, and stays. `expected`: the other files that were written.
Result<void> settle_textures(const fs::path& written, const fs::path& folder, const std::set<fs::path>& expected) {
  std::error_code error;
  std::vector<fs::path> kept;
  for (fs::directory_iterator entry(written, error), end; !error && entry != end; entry.increment(error)) {
    const fs::path name = entry->path().filename(), target = folder / name;
    if (expected.contains(name) || !is_there(target)) continue;
    if (!same_bytes(entry->path(), target)) {
      return not_replaced(target, "is there already with other content than the texture of this name",
                          "choose another output folder");
    }
    kept.push_back(entry->path());
  }
  for (const fs::path& path : kept) {
    if (!error) fs::remove(path, error);
  }
  if (error) return fail(ErrorCode::cannot_write, error.message(), folder.string());
  return {};
}

// ---- writing ----

tl::unexpected<Error> unknown_extension(const fs::path& path) {
  return fail(ErrorCode::unsupported,
              fmt::format("'{}' is not a format that can be written", path.extension().string()), path.string(),
              fmt::format("these can: {}", fmt::join(kExtensions, " ")));
}

// One model, straight to its place.
Result<WriteReport> write_plain(const Model& model, const fs::path& path, const WriteOptions& options,
                                const Task& task) {
  const std::string e = extension_of(path);
  if (is_gltf(e)) return write_gltf(model, path, options, task);
  if (has_light_colors(model)) return write_plain(with_shown_colors(model), path, options, task);
  if (e == ".ply") return write_ply(model, path, task);
  if (e == ".obj") return write_obj(model, path, task);
  if (e == ".stl") return write_stl(model, path, task);
  if (e == ".off") return write_off(model, path, task);
  return unknown_extension(path);
}

// Users know nothing of hidden folders: names in them become those that the files were to have.
Error with_final_names(Error error, const fs::path& hidden, const fs::path& folder) {
  const std::string from = (hidden / "").string(), to = folder.empty() ? "" : (folder / "").string();
  for (std::string* text : {&error.where, &error.what, &error.remedy}) {
    for (std::size_t at = text->find(from); at != std::string::npos; at = text->find(from, at + to.size())) {
      text->replace(at, from.size(), to);
    }
  }
  return error;
}

// What `write` puts into the folder that it is given appears beside `path`: all of it, or nothing.
Result<WriteReport> write_staged(const fs::path& path,
                                 const std::function<Result<WriteReport>(const fs::path&)>& write) {
  Result<StagingFolder> staging = StagingFolder::create(path);
  LODESTONE_TRY(staging);
  const fs::path folder = path.parent_path();
  Result<WriteReport> report = write(staging->path());
  if (!report) return fail(with_final_names(report.error(), staging->path(), folder));
  std::set<fs::path> expected;
  for (fs::path& file : report->files) {
    file = folder / file.filename();
    expected.insert({file.filename(), companion_of(file).filename()});
  }
  LODESTONE_TRY(settle_textures(staging->path(), folder, expected));
  LODESTONE_TRY(staging->commit());
  return report;
}

Result<WriteReport> write_level_files(const Ladder& ladder, const fs::path& pattern, const WriteOptions& options,
                                      const Task& task) {
  return write_staged(pattern, [&](const fs::path& hidden) -> Result<WriteReport> {
    WriteReport all;
    for (std::size_t level = 0; level < ladder.levels.size(); ++level) {
      const Task part = task.part(1.0 / static_cast<double>(ladder.levels.size()));
      const fs::path file = level_file(hidden / pattern.filename(), level);
      Result<WriteReport> one = write_plain(ladder.model(level), file, options, part);
      if (!one) return one;
      all.files.push_back(file);
      all.level_bytes.push_back(one->total_bytes);
      all.total_bytes += one->total_bytes;
      if (level == 0) all.warnings = std::move(one->warnings);
    }
    return all;
  });
}

}  // namespace

bool is_writable_extension(std::string_view extension) {
  const std::string e = lower_case(extension);
  return std::find(kExtensions.begin(), kExtensions.end(), e) != kExtensions.end();
}

Result<void> check_model_name(const fs::path& path, Compression compression) {
  const std::string e = extension_of(path);
  if (!is_writable_extension(e)) return unknown_extension(path);
  if (compression == Compression::none || is_gltf(e)) return {};
  return fail(ErrorCode::bad_argument, fmt::format("{} files hold no compressed geometry", e), path.string(),
              "write .glb or leave `compression` off");
}

Result<void> check_ladder_name(const fs::path& path, Compression compression) {
  LODESTONE_TRY(check_model_name(path, compression));
  const std::string e = extension_of(path);
  if (is_gltf(e) || is_pattern(path)) return {};
  return fail(ErrorCode::bad_argument, fmt::format("a {} file holds one level", e), path.string(),
              fmt::format("write name.glb for all levels in one file, or name_LOD{{level}}{} for a file a level", e));
}

Result<void> check_replaced(const Model& input, const fs::path& path, std::size_t levels) {
  if (!input.files.empty() && same_file(input.files.front(), path)) return {};  // written over itself on purpose
  for (std::size_t level = 0; level < (is_pattern(path) ? levels : 1); ++level) {
    const fs::path file = level_file(path, level), companion = companion_of(file);
    LODESTONE_TRY(check_target(input, file, file));
    if (companion.empty() || !has_side_files(input, extension_of(file))) continue;
    LODESTONE_TRY(check_target(input, companion, file));
  }
  return {};
}

Result<WriteReport> write_model(const Model& model, const fs::path& path, const WriteOptions& options, Task task) {
  LODESTONE_TRY(check_model_name(path, options.compression));
  LODESTONE_TRY(check_replaced(model, path, 1));
  if (!has_side_files(model, extension_of(path))) return write_plain(model, path, options, task);
  return write_staged(
      path, [&](const fs::path& hidden) { return write_plain(model, hidden / path.filename(), options, task); });
}

Result<WriteReport> write_ladder(const Ladder& ladder, const fs::path& path, const WriteOptions& options, Task task) {
  LODESTONE_TRY(check_ladder_name(path, options.compression));
  LODESTONE_TRY(check_replaced(ladder.original, path, ladder.levels.size()));
  if (is_pattern(path)) {
    LODESTONE_TRY(validate(ladder, task));
    return write_level_files(ladder, path, options, task);
  }
  if (!has_side_files(ladder.original, extension_of(path))) return write_gltf(ladder, path, options, task);
  return write_staged(
      path, [&](const fs::path& hidden) { return write_gltf(ladder, hidden / path.filename(), options, task); });
}

}  // namespace lodestone::io
