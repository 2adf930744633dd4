#include "lodestone/io/read.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <new>
#include <span>

#include "lodestone/base/file.h"
#include "lodestone/base/text.h"
#include "lodestone/core/validate.h"
#include "lodestone/io/assimp.h"
#include "lodestone/io/content.h"
#include "lodestone/io/draco.h"
#include "lodestone/io/gltf/read.h"
#include "lodestone/io/plain/obj.h"
#include "lodestone/io/plain/off.h"
#include "lodestone/io/plain/ply.h"
#include "lodestone/io/plain/stl.h"
#include "lodestone/io/text_reader_detail.h"

namespace lodestone::io {

namespace {

using Reader = Result<Model> (*)(const std::filesystem::path&, const ReadOptions&, Task);

struct Format {
  std::string_view extension;
  Reader reader;
  bool foreign;
};

constexpr std::array<Format, 7> kFormats{{
    {".ply", [](const std::filesystem::path& p, const ReadOptions&, Task t) { return read_ply(p, std::move(t)); },
     false},
    {".obj", [](const std::filesystem::path& p, const ReadOptions&, Task t) { return read_obj(p, std::move(t)); },
     false},
    {".stl", [](const std::filesystem::path& p, const ReadOptions&, Task t) { return read_stl(p, std::move(t)); },
     false},
    {".off", [](const std::filesystem::path& p, const ReadOptions&, Task t) { return read_off(p, std::move(t)); },
     false},
    {".gltf",
     [](const std::filesystem::path& p, const ReadOptions& o, Task t) { return read_gltf(p, o, std::move(t)); }, false},
    {".glb", [](const std::filesystem::path& p, const ReadOptions& o, Task t) { return read_gltf(p, o, std::move(t)); },
     false},
    {".drc", [](const std::filesystem::path& p, const ReadOptions&, Task t) { return read_drc(p, std::move(t)); },
     true},
}};

const Format* find_format(std::string_view extension) {
  const auto found =
      std::find_if(kFormats.begin(), kFormats.end(), [&](const Format& f) { return f.extension == extension; });
  return found == kFormats.end() ? nullptr : &*found;
}

bool is_assimp_extension(std::string_view extension) {
  const auto known = assimp_extensions();
  return std::find(known.begin(), known.end(), extension) != known.end();
}

// What the first bytes say, for the formats that say anything; empty for the others (OBJ, ASCII STL and OFF).
std::string_view extension_by_content(std::span<const char> head) {
  const auto begins = [&](std::string_view magic) {
    return head.size() >= magic.size() && std::memcmp(head.data(), magic.data(), magic.size()) == 0;
  };
  if (begins("ply\n") || begins("ply\r")) return ".ply";
  if (begins("glTF")) return ".glb";
  if (begins("DRACO")) return ".drc";
  return {};
}

std::string known_extensions() { return fmt::format("{}", fmt::join(readable_extensions(), " ")); }

Result<Model> read_by(const Format* format, const std::filesystem::path& path, const ReadOptions& options,
                      const Task& task) {
  try {
    return format != nullptr ? format->reader(path, options, task) : read_assimp(path, task);
  } catch (const std::bad_alloc&) {
    return fail(ErrorCode::out_of_memory, "needs more memory than there is", path.string(),
                "close other programs or use a machine with more");
  }
}

Result<Model> read_named(const std::filesystem::path& path, const ReadOptions& options, const Task& task);

}  // namespace

bool is_model_extension(std::string_view extension) {
  const std::string e = lower_case(extension);
  return find_format(e) != nullptr || is_assimp_extension(e);
}

bool is_foreign_extension(std::string_view extension) {
  const std::string e = lower_case(extension);
  const Format* format = find_format(e);
  return format != nullptr ? format->foreign : is_assimp_extension(e);
}

std::vector<std::string> readable_extensions() {
  std::vector<std::string> out;
  for (const Format& f : kFormats) out.emplace_back(f.extension);
  for (const std::string_view e : assimp_extensions()) out.emplace_back(e);
  return out;
}

Result<Model> read_model(const std::filesystem::path& path, const ReadOptions& options, Task task) {
  Result<Model> model = read_named(path, options, task);
  if (!model) return fail(told_by_content(model.error(), path));
  return model;
}

namespace {

// By the reader that the name asks for.
Result<Model> read_named(const std::filesystem::path& path, const ReadOptions& options, const Task& task) {
  const std::string extension = extension_of(path);
  std::array<char, 8> head{};
  std::size_t head_size = 0;
  {
    Result<InputFile> file = InputFile::open(path);
    LODESTONE_TRY(file);
    const Result<std::size_t> got = file->read(std::as_writable_bytes(std::span(head)));
    LODESTONE_TRY(got);
    head_size = *got;
  }
  if (!is_model_extension(extension)) {
    return fail(ErrorCode::unsupported,
                extension.empty() ? "has no extension to tell its format by"
                                  : fmt::format("'{}' is not a format that can be read", extension),
                path.string(), "these can: " + known_extensions());
  }
  if (head_size == 0) return fail(ErrorCode::empty, "is empty (0 bytes)", path.string(), "export it again");
  const std::string_view content = extension_by_content(std::span(head).first(head_size));
  const bool fits = content.empty() || content == extension || (content == ".glb" && extension == ".gltf");
  if (!fits) {
    return fail(ErrorCode::bad_format, fmt::format("is named {} but holds {}", extension, content), path.string(),
                fmt::format("rename it to end in {}", content));
  }
  Result<Model> model = read_by(find_format(extension), path, options, task);
  if (!model) return model;
  model->files.insert(model->files.begin(), path);
  if (!is_foreign_extension(extension)) return model;  // our own readers have looked already
  if (const Result<void> ok = validate(*model); !ok) {
    Error error = ok.error();
    error.code = ErrorCode::bad_format;
    error.where = error.where.empty() ? path.string() : path.string() + ": " + error.where;
    return fail(std::move(error));
  }
  return model;
}

}  // namespace

}  // namespace lodestone::io
