#include "lodestone/io/write.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "lodestone/base/file.h"
#include "lodestone/io/gltf_write.h"
#include "lodestone/io/obj_write.h"
#include "lodestone/io/off_write.h"
#include "lodestone/io/ply_write.h"
#include "lodestone/io/stl_write.h"

namespace lodestone::io {

namespace {

constexpr std::string_view kLevelMark = "{level}";
constexpr std::array<std::string_view, 6> kExtensions{".glb", ".gltf", ".ply", ".obj", ".stl", ".off"};

std::string lower_extension(const std::filesystem::path& path) {
  std::string e = path.extension().string();
  for (char& c : e) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return e;
}

bool is_gltf(std::string_view extension) { return extension == ".glb" || extension == ".gltf"; }

tl::unexpected<Error> unknown_extension(const std::filesystem::path& path) {
  return fail(ErrorCode::unsupported,
              fmt::format("'{}' is not a format that can be written", path.extension().string()), path.string(),
              fmt::format("these can: {}", fmt::join(kExtensions, " ")));
}

// All levels (each may be several files) are written into a staging folder first: all of them appear, or none.
Result<WriteReport> write_level_files(const Ladder& ladder, const std::filesystem::path& pattern,
                                      const WriteOptions& options, const Task& task) {
  Result<StagingFolder> staging = StagingFolder::create(pattern);
  if (!staging) return fail(staging.error());
  WriteReport all;
  const std::string name = pattern.filename().string();
  for (std::size_t level = 0; level < ladder.levels.size(); ++level) {
    std::string file = name;
    file.replace(name.find(kLevelMark), kLevelMark.size(), std::to_string(level));
    const Task part = task.part(1.0 / static_cast<double>(ladder.levels.size()));
    Result<WriteReport> one = write_model(ladder.model(level), staging->path() / file, options, part);
    if (!one) return one;
    all.files.push_back(pattern.parent_path() / file);
    all.level_bytes.push_back(one->total_bytes);
    all.total_bytes += one->total_bytes;
    if (level == 0) all.warnings = std::move(one->warnings);
  }
  if (const Result<void> ok = staging->commit(); !ok) return fail(ok.error());
  return all;
}

}  // namespace

bool is_writable_extension(std::string_view extension) {
  const std::string e = lower_extension(std::filesystem::path("x" + std::string(extension)));
  return std::find(kExtensions.begin(), kExtensions.end(), e) != kExtensions.end();
}

Result<WriteReport> write_model(const Model& model, const std::filesystem::path& path, const WriteOptions& options,
                                Task task) {
  const std::string e = lower_extension(path);
  if (is_gltf(e)) return write_gltf(model, path, options, task);
  if (options.compression != Compression::none) {
    return fail(ErrorCode::bad_argument, fmt::format("{} files hold no compressed geometry", e), path.string(),
                "write .glb or leave --compress off");
  }
  if (e == ".ply") return write_ply(model, path, task);
  if (e == ".obj") return write_obj(model, path, task);
  if (e == ".stl") return write_stl(model, path, task);
  if (e == ".off") return write_off(model, path, task);
  return unknown_extension(path);
}

Result<WriteReport> write_ladder(const Ladder& ladder, const std::filesystem::path& path, const WriteOptions& options,
                                 Task task) {
  const std::string text = path.string();
  const std::string e = lower_extension(path);
  if (!is_writable_extension(e)) return unknown_extension(path);
  if (path.filename().string().find(kLevelMark) != std::string::npos) {
    return write_level_files(ladder, path, options, task);
  }
  if (is_gltf(e)) return write_gltf(ladder, path, options, task);
  return fail(ErrorCode::bad_argument, fmt::format("a {} file holds one level", e), text,
              fmt::format("write name.glb for all levels in one file, or name_LOD{{level}}{} for a file a level", e));
}

}  // namespace lodestone::io
