// From a file's bytes to a document: container, JSON, buffers, external images. Every count is checked against the
// bytes that are there.
#include "lodestone/io/gltf/document.h"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "lodestone/base/file.h"
#include "lodestone/io/gltf/gltf_detail.h"
#include "lodestone/io/gltf/uri_detail.h"
#include "lodestone/io/images/file_detail.h"

namespace lodestone::io {

Document::Document(std::unique_ptr<const Data> data) : data_(std::move(data)) {}
Document::~Document() = default;
std::size_t Document::node_count() const { return array_member(data_->json, "nodes").size(); }
std::size_t Document::material_count() const { return array_member(data_->json, "materials").size(); }
std::size_t Document::animation_count() const { return array_member(data_->json, "animations").size(); }
std::size_t Document::skin_count() const { return array_member(data_->json, "skins").size(); }

std::string place(const Document::Data& data, std::string_view what, std::size_t index) {
  return fmt::format("{}: {} {}", data.name, what, index);
}

tl::unexpected<Error> unfolds_too_far(const Document::Data& data, std::string_view what, const std::string& where) {
  return fail(ErrorCode::bad_format,
              fmt::format("{} unfold to more than {} times the {} bytes read", what, kUnfoldFactor, data.file_bytes),
              where, "is the file broken?");
}

namespace {

ByteSpan as_bytes_of(std::string_view text) { return std::as_bytes(std::span(text.data(), text.size())); }

std::string_view as_text(ByteSpan bytes) { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }

// Everything that loading shares.
struct Loader {
  Document::Data& data;
  std::filesystem::path folder;
  bool has_folder = false;
  std::vector<std::string>& warnings;
  Task task;
  std::map<std::string, ByteSpan> files;  // external files already read
  std::string_view bin;
  bool has_bin = false;
};

ByteSpan keep(Document::Data& data, std::string bytes) {
  data.file_bytes += bytes.size();
  data.storage.push_back(std::make_shared<const std::string>(std::move(bytes)));
  return as_bytes_of(*data.storage.back());
}

Result<void> check_asset(const Document::Data& data) {
  if (!data.json.is_object()) return fail(ErrorCode::bad_format, "the JSON is not an object", data.name, "is it glTF?");
  const Json* asset = member(data.json, "asset");
  const std::string version = asset != nullptr ? string_member(*asset, "version") : "";
  if (version.empty()) {
    return fail(ErrorCode::bad_format, "asset.version is missing", data.name, "is it a glTF 2.0 file?");
  }
  const std::string least = string_member(*asset, "minVersion");
  if (version.substr(0, 2) != "2." || (!least.empty() && least != "2.0")) {
    return fail(ErrorCode::unsupported,
                fmt::format("glTF version {}, only 2.0 is read", least.empty() ? version : least), data.name,
                "export it again as glTF 2.0");
  }
  return {};
}

// The first `limit` bytes of the file at most.
Result<std::string> read_part(const std::filesystem::path& path, std::uint64_t limit) {
  Result<InputFile> file = InputFile::open(path);
  LODESTONE_TRY(file);
  if (limit >= file->size()) return read_file(path);
  std::string bytes(static_cast<std::size_t>(limit), '\0');
  const Result<std::size_t> got = file->read(std::as_writable_bytes(std::span(bytes)));
  LODESTONE_TRY(got);
  bytes.resize(*got);
  return bytes;
}

Result<ByteSpan> external_file(Loader& loader, const std::string& uri, std::uint64_t limit, const std::string& where) {
  if (!loader.has_folder) {
    return fail(ErrorCode::bad_format, fmt::format("names the file '{}', but was read from memory", uri), where);
  }
  const Result<std::filesystem::path> path = resolve_uri(loader.folder, uri, where);
  LODESTONE_TRY(path);
  const auto known = loader.files.find(path->string());
  if (known != loader.files.end() && known->second.size() >= limit) return known->second;
  Result<std::string> bytes = read_part(*path, limit);
  LODESTONE_TRY(bytes);
  loader.data.files.push_back(*path);
  return loader.files[path->string()] = keep(loader.data, std::move(*bytes));
}

Result<ByteSpan> load_buffer(Loader& loader, std::size_t index, Json& buffer) {
  const std::string where = place(loader.data, "buffer", index);
  const Result<std::uint64_t> length = uint_member(buffer, "byteLength", 0, where);
  LODESTONE_TRY(length);
  const std::string uri = string_member(buffer, "uri");
  ByteSpan bytes;
  if (uri.empty()) {
    if (index != 0 || !loader.has_bin) return bytes;  // legal; a view that needs it is an error
    bytes = as_bytes_of(loader.bin);
  } else if (is_data_uri(uri)) {
    Result<DataUri> decoded = decode_data_uri(uri, where);
    LODESTONE_TRY(decoded);
    bytes = keep(loader.data, std::move(decoded->bytes));
    buffer.erase("uri");
  } else {
    const Result<ByteSpan> file = external_file(loader, uri, *length, where);
    LODESTONE_TRY(file);
    bytes = *file;
  }
  if (*length > bytes.size()) {
    return fail(ErrorCode::bad_format, fmt::format("byteLength is {}, but {} bytes are there", *length, bytes.size()),
                where, "is the file cut off?");
  }
  return bytes.first(static_cast<std::size_t>(*length));
}

// A fallback is not read, and may be missing; but one that is there belongs to the model and must not be overwritten.
void skip_buffer(Loader& loader, Json& buffer) {
  const std::string uri = string_member(buffer, "uri");
  if (is_data_uri(uri)) buffer.erase("uri");
  if (uri.empty() || is_data_uri(uri) || !loader.has_folder) return;
  const Result<std::filesystem::path> path = resolve_uri(loader.folder, uri, {});
  std::error_code none;
  if (path && std::filesystem::exists(*path, none)) loader.data.files.push_back(*path);
}

Result<void> load_buffers(Loader& loader) {
  const auto buffers = loader.data.json.find("buffers");
  if (buffers == loader.data.json.end() || !buffers->is_array()) return {};
  const std::vector<bool> unread = unread_buffers(loader.data.json);
  for (std::size_t i = 0; i < buffers->size(); ++i) {
    if (loader.task.cancelled()) return cancelled_error("reading");
    if (unread[i]) {
      skip_buffer(loader, (*buffers)[i]);
      loader.data.buffers.emplace_back();
      continue;
    }
    const Result<ByteSpan> bytes = load_buffer(loader, i, (*buffers)[i]);
    LODESTONE_TRY(bytes);
    loader.data.buffers.push_back(*bytes);
  }
  return {};
}

Result<void> load_images(Loader& loader) {
  const Json& images = array_member(loader.data.json, "images");
  for (std::size_t i = 0; i < images.size(); ++i) {
    if (loader.task.cancelled()) return cancelled_error("reading");
    const std::string uri = string_member(images[i], "uri");
    if (uri.empty() || is_data_uri(uri) || !loader.has_folder) continue;
    const std::string where = place(loader.data, "image", i);
    const Result<std::filesystem::path> path = resolve_uri(loader.folder, uri, where);
    LODESTONE_TRY(path);
    const Result<ByteSpan> file = external_file(loader, uri, UINT64_MAX, where);
    if (!file) {
      loader.warnings.push_back(fmt::format("image {} ('{}') could not be read: {}", i, uri, file.error().what));
      continue;
    }
    std::string mime = image_mime(*file);
    if (mime.empty()) mime = string_member(images[i], "mimeType");
    loader.data.images.push_back({i, std::move(mime), *file});
  }
  return {};
}

// Nobody names it: it keeps its index and four bytes.
void empty_view(Document::Data& data, std::size_t view) {
  static constexpr std::array<std::byte, 4> kNothing{};
  data.views[view] = {};
  data.views[view].bytes = kNothing;
  data.json["bufferViews"][view] = {{"buffer", 0}, {"byteOffset", 0}, {"byteLength", 4}};
}

}  // namespace

Result<std::unique_ptr<Document::Data>> load_document(std::string bytes, std::string name,
                                                      const std::filesystem::path& path, const ReadOptions& options,
                                                      std::vector<std::string>& warnings, const Task& task) {
  auto data = std::make_unique<Document::Data>();
  data->name = std::move(name);
  data->path = path;
  if (bytes.empty()) return fail(ErrorCode::bad_format, "the file is empty", data->name, "export the model again");
  keep(*data, std::move(bytes));
  std::string_view text = *data->storage.front();
  Loader loader{*data, path.parent_path(), !path.empty(), warnings, task, {}, {}, false};
  if (is_glb(text)) {
    const Result<GlbParts> parts = split_glb(text, data->name, warnings);
    LODESTONE_TRY(parts);
    text = parts->json;
    loader.bin = parts->bin;
    loader.has_bin = parts->bin.data() != nullptr;
  }
  Result<Json> json = parse_json(text, data->name);
  LODESTONE_TRY(json);
  data->json = std::move(*json);
  if (const auto good = check_asset(*data); !good) return fail(good.error());
  std::vector<std::size_t> emptied;
  if (!options.levels && options.draw_level > 0) emptied = keep_level(data->json, options.draw_level);
  if (!options.levels) drop_levels(data->json);
  if (const auto good = load_buffers(loader); !good) return fail(good.error());
  if (const auto good = load_images(loader); !good) return fail(good.error());
  if (const auto good = load_views(*data, task); !good) return fail(good.error());
  for (const std::size_t view : emptied) {
    if (view < data->views.size()) empty_view(*data, view);
  }
  return data;
}

ImageBytes image_bytes(const Document::Data& data, std::size_t image) {
  const Json& images = array_member(data.json, "images");
  if (image >= images.size()) return {};
  for (const ExternalImage& external : data.images) {
    if (external.image == image) return {std::string(as_text(external.bytes)), external.mime};
  }
  const Json& json = images[image];
  ImageBytes out;
  if (const Json* view = member(json, "bufferView"); view != nullptr) {
    const std::optional<std::uint64_t> index = as_uint(*view);
    if (!index || *index >= data.views.size()) return {};
    out.bytes = as_text(data.views[static_cast<std::size_t>(*index)].bytes);
  } else if (const std::string uri = string_member(json, "uri"); is_data_uri(uri)) {
    Result<DataUri> decoded = decode_data_uri(uri, "");
    if (!decoded) return {};
    out.bytes = std::move(decoded->bytes);
  }
  out.mime = image_mime(as_bytes_of(out.bytes));
  if (out.mime.empty()) out.mime = string_member(json, "mimeType");
  return out;
}

}  // namespace lodestone::io
