#include "lodestone/io/content.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <span>

#include "lodestone/base/file.h"
#include "lodestone/base/text.h"

namespace lodestone::io {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view kUnpack = "unpack it, and name the model inside";
constexpr std::string_view kPicture = "name the model itself";
constexpr std::string_view kExport = "export it as glTF, OBJ or PLY with the program that made it";
constexpr std::string_view kDownload = "a download may have failed: fetch it again";

struct Magic {
  std::string_view bytes;
  Content content;
  std::string_view fits;  // endings of names that such bytes belong to, each with a space behind it
};

constexpr Magic kMagics[] = {
    {"ply\n"sv, {"PLY", ".ply", {}}, ".ply "},
    {"ply\r"sv, {"PLY", ".ply", {}}, ".ply "},
    {"glTF"sv, {"GLB", ".glb", {}}, ".glb .gltf "},
    {"DRACO"sv, {"Draco", ".drc", {}}, ".drc "},
    {"OFF\n"sv, {"OFF", ".off", {}}, ".off "},
    {"OFF\r"sv, {"OFF", ".off", {}}, ".off "},
    {"LASF"sv, {"LAS", ".las", {}}, ".las .laz "},
    {"# .PCD"sv, {"PCD", ".pcd", {}}, ".pcd "},
    {"NRRD000"sv, {"NRRD", ".nrrd", {}}, ".nrrd .nhdr "},
    {"Kaydara FBX Binary"sv, {"FBX", ".fbx", {}}, ".fbx "},
    {"PK\x03\x04"sv, {"a ZIP archive", {}, kUnpack}, ".3mf "},
    {"PK\x05\x06"sv, {"an empty ZIP archive", {}, kDownload}, ""},
    {"\x1f\x8b"sv, {"gzip", {}, kUnpack}, ".gz .blend .mgz "},
    {"\x28\xb5\x2f\xfd"sv, {"Zstandard", {}, kUnpack}, ".blend "},
    {"7z\xbc\xaf\x27\x1c"sv, {"a 7-Zip archive", {}, kUnpack}, ""},
    {"Rar!\x1a\x07"sv, {"a RAR archive", {}, kUnpack}, ""},
    {"\xfd\x37zXZ\0"sv, {"xz", {}, kUnpack}, ""},
    {"BZh"sv, {"bzip2", {}, kUnpack}, ""},
    {"\x89PNG\r\n"sv, {"a PNG picture", {}, kPicture}, ".png "},
    {"\xff\xd8\xff"sv, {"a JPEG picture", {}, kPicture}, ".jpg .jpeg "},
    {"GIF8"sv, {"a GIF picture", {}, kPicture}, ""},
    {"II*\0"sv, {"a TIFF picture", {}, kPicture}, ".tif .tiff "},
    {"MM\0*"sv, {"a TIFF picture", {}, kPicture}, ".tif .tiff "},
    {"%PDF-"sv, {"a PDF document", {}, kPicture}, ""},
    {"SQLite format 3"sv, {"an SQLite database", {}, kExport}, ""},
    {"\x7f"
     "ELF"sv,
     {"a program", {}, kPicture},
     ""},
    {"BLENDER"sv, {"a Blender file", ".blend", {}}, ".blend "},
    {"version https://git-lfs"sv, {"a Git LFS pointer", {}, "fetch the file itself with 'git lfs pull'"}, ""},
};

// Of texts, whose beginnings may differ in case and white space.
constexpr Magic kTexts[] = {
    {"<!doctype html"sv, {"a web page (HTML)", {}, kDownload}, ""},
    {"<html"sv, {"a web page (HTML)", {}, kDownload}, ""},
    {"<?xml"sv, {"XML", {}, kExport}, ".dae .x3d .xml .amf "},
    {"<collada"sv, {"COLLADA", ".dae", {}}, ".dae "},
    {"{"sv, {"JSON", {}, "is it a .gltf, or the answer of a server?"}, ".gltf .glb .json "},
};

constexpr std::size_t kHeadBytes = 512;

bool is_binary_stl(std::string_view head, std::uint64_t file_size) {
  constexpr std::size_t kHeader = 84, kTriangle = 50;
  if (head.size() < kHeader) return false;
  std::uint32_t triangles = 0;
  std::memcpy(&triangles, head.data() + 80, sizeof triangles);
  return triangles > 0 && file_size == kHeader + std::uint64_t{triangles} * kTriangle;
}

const Magic* find_magic(std::string_view head) {
  for (const Magic& magic : kMagics) {
    if (head.starts_with(magic.bytes)) return &magic;
  }
  if (head.starts_with("\xef\xbb\xbf")) head.remove_prefix(3);
  head.remove_prefix(std::min(head.find_first_not_of(" \t\r\n"), head.size()));
  const std::string text = lower_case(head.substr(0, 32));
  for (const Magic& magic : kTexts) {
    if (text.starts_with(magic.bytes)) return &magic;
  }
  return nullptr;
}

}  // namespace

Content content_of(std::string_view head, std::uint64_t file_size) {
  if (is_binary_stl(head, file_size)) return {"binary STL", ".stl", {}};
  const Magic* magic = find_magic(head);
  return magic == nullptr ? Content{} : magic->content;
}

Error told_by_content(Error error, const std::filesystem::path& path) {
  const bool senseless =
      error.code == ErrorCode::bad_format || error.code == ErrorCode::unsupported || error.code == ErrorCode::empty;
  if (!senseless) return error;
  Result<InputFile> file = InputFile::open(path);
  if (!file) return error;
  std::array<char, kHeadBytes> bytes{};
  const Result<std::size_t> got = file->read(std::as_writable_bytes(std::span(bytes)));
  if (!got) return error;
  const std::string_view head(bytes.data(), *got);
  const std::string extension = extension_of(path);
  const Content content = content_of(head, file->size());
  if (content.name.empty() || content.extension == extension) return error;
  const Magic* magic = find_magic(head);
  if (magic != nullptr && !extension.empty() && magic->fits.find(extension + ' ') != std::string_view::npos)
    return error;
  if (!content.extension.empty()) {
    const std::string named = extension.empty() ? "has no extension" : "is named " + extension;
    return Error{ErrorCode::bad_format, fmt::format("{} but holds {}", named, content.name), path.string(),
                 fmt::format("rename it to end in {}", content.extension)};
  }
  const std::string instead = extension.empty() ? std::string() : fmt::format(", not {}", extension);
  return Error{ErrorCode::bad_format, fmt::format("looks like {}{}", content.name, instead), path.string(),
               std::string(content.remedy)};
}

}  // namespace lodestone::io
