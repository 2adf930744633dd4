// Buffer views: ranges of buffers, decoded where meshopt compressed them, and which buffers they need.
#include <fmt/format.h>

#include <utility>

#include "lodestone/io/gltf/gltf_detail.h"
#include "lodestone/io/gltf/meshopt_detail.h"

namespace lodestone::io {

const Json* meshopt_of(const Json& holder) {
  const Json* extensions = member(holder, "extensions");
  if (extensions == nullptr) return nullptr;
  for (const char* name : kMeshoptNames) {
    if (const Json* found = member(*extensions, name); found != nullptr) return found;
  }
  return nullptr;
}

namespace {

void mark(std::vector<bool>& marks, const Json& holder) {
  const Json* index = member(holder, "buffer");
  const std::uint64_t i = index != nullptr ? as_uint(*index).value_or(marks.size()) : marks.size();
  if (i < marks.size()) marks[static_cast<std::size_t>(i)] = true;
}

}  // namespace

std::vector<bool> unread_buffers(const Json& json) {
  const std::size_t count = array_member(json, "buffers").size();
  std::vector<bool> fallback(count, false), read(count, false);
  for (const Json& view : array_member(json, "bufferViews")) {
    const Json* meshopt = meshopt_of(view);
    if (meshopt != nullptr) mark(read, *meshopt);
    mark(meshopt != nullptr && has_meshopt() ? fallback : read, view);
  }
  for (std::size_t i = 0; i < count; ++i) fallback[i] = fallback[i] && !read[i];
  return fallback;
}

namespace {

ByteSpan as_bytes_of(std::string_view text) { return std::as_bytes(std::span(text.data(), text.size())); }

// A range of a buffer as a bufferView or its meshopt extension names it.
Result<ByteSpan> buffer_range(const Document::Data& data, const Json& range, const std::string& where) {
  const Result<std::size_t> buffer = index_member(range, "buffer", data.buffers.size(), "buffers", where);
  LODESTONE_TRY(buffer);
  const Result<std::uint64_t> offset = uint_member(range, "byteOffset", 0, where);
  LODESTONE_TRY(offset);
  const Result<std::uint64_t> length = uint_member(range, "byteLength", 0, where);
  LODESTONE_TRY(length);
  const ByteSpan bytes = data.buffers[*buffer];
  if (bytes.data() == nullptr) {
    return fail(ErrorCode::bad_format, "has no uri, and no binary chunk stands for it", place(data, "buffer", *buffer),
                "is the file cut off?");
  }
  if (*offset > bytes.size() || *length > bytes.size() - *offset) {
    return fail(
        ErrorCode::bad_format,
        fmt::format("bytes {} to {} are named, buffer {} has {}", *offset, *offset + *length, *buffer, bytes.size()),
        where, "is the file cut off?");
  }
  return bytes.subspan(static_cast<std::size_t>(*offset), static_cast<std::size_t>(*length));
}

Result<MeshoptCoding> read_coding(const Json& meshopt, const std::string& where) {
  MeshoptCoding out;
  const Result<std::uint64_t> count = uint_member(meshopt, "count", 0, where);
  LODESTONE_TRY(count);
  const Result<std::uint64_t> stride = uint_member(meshopt, "byteStride", 0, where);
  LODESTONE_TRY(stride);
  out.count = static_cast<std::size_t>(*count);
  out.stride = static_cast<std::size_t>(*stride);
  const std::string mode = string_member(meshopt, "mode"), filter = string_member(meshopt, "filter");
  constexpr std::pair<std::string_view, MeshoptMode> modes[] = {{"ATTRIBUTES", MeshoptMode::attributes},
                                                                {"TRIANGLES", MeshoptMode::triangles},
                                                                {"INDICES", MeshoptMode::indices}};
  constexpr std::pair<std::string_view, MeshoptFilter> filters[] = {{"", MeshoptFilter::none},
                                                                    {"NONE", MeshoptFilter::none},
                                                                    {"OCTAHEDRAL", MeshoptFilter::octahedral},
                                                                    {"QUATERNION", MeshoptFilter::quaternion},
                                                                    {"EXPONENTIAL", MeshoptFilter::exponential},
                                                                    {"COLOR", MeshoptFilter::color}};
  bool mode_known = false, filter_known = false;
  for (const auto& [name, value] : modes) {
    if (name != mode) continue;
    out.mode = value;
    mode_known = true;
  }
  for (const auto& [name, value] : filters) {
    if (name != filter) continue;
    out.filter = value;
    filter_known = true;
  }
  if (!mode_known) return fail(ErrorCode::bad_format, fmt::format("the meshopt mode '{}' is unknown", mode), where);
  if (!filter_known) {
    return fail(ErrorCode::bad_format, fmt::format("the meshopt filter '{}' is unknown", filter), where);
  }
  return out;
}

Result<View> decode_view(Document::Data& data, const Json& meshopt, std::size_t stride, Budget& budget,
                         const std::string& where) {
  const Result<ByteSpan> range = buffer_range(data, meshopt, where);
  LODESTONE_TRY(range);
  const Result<MeshoptCoding> coding = read_coding(meshopt, where);
  LODESTONE_TRY(coding);
  LODESTONE_TRY(check_meshopt(*coding, range->size(), where));
  if (!budget.take(coding->count * coding->stride)) return unfolds_too_far(data, "the compressed views", where);
  Result<std::string> bytes = decode_meshopt(*range, *coding, where);
  LODESTONE_TRY(bytes);
  data.storage.push_back(std::make_shared<const std::string>(std::move(*bytes)));
  View view;
  view.bytes = as_bytes_of(*data.storage.back());
  view.stride = stride;
  return view;
}

Result<View> load_view(Document::Data& data, const Json& json, std::size_t index, Budget& budget) {
  const std::string where = place(data, "bufferView", index);
  const Result<std::uint64_t> stride = uint_member(json, "byteStride", 0, where);
  LODESTONE_TRY(stride);
  if (*stride > 65536) return fail(ErrorCode::bad_format, fmt::format("byteStride is {}, at most 252", *stride), where);
  if (const Json* meshopt = meshopt_of(json); meshopt != nullptr) {
    const Result<std::size_t> buffer = index_member(json, "buffer", data.buffers.size(), "buffers", where);
    LODESTONE_TRY(buffer);
    const bool has_fallback = !data.buffers[*buffer].empty();
    if (has_meshopt() || !has_fallback) {
      return decode_view(data, *meshopt, static_cast<std::size_t>(*stride), budget, where);
    }
  }
  const Result<ByteSpan> bytes = buffer_range(data, json, where);
  LODESTONE_TRY(bytes);
  return View{*bytes, static_cast<std::size_t>(*stride)};
}

}  // namespace

Result<void> load_views(Document::Data& data, const Task& task) {
  const Json& views = array_member(data.json, "bufferViews");
  Budget budget = unfold_budget(data.file_bytes);  // bytes that compressed views may unfold to
  data.views.reserve(views.size());
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (task.cancelled()) return cancelled_error("reading");
    Result<View> view = load_view(data, views[i], i, budget);
    LODESTONE_TRY(view);
    data.views.push_back(std::move(*view));
  }
  return {};
}

}  // namespace lodestone::io
