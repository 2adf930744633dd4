// Accessors: from JSON to checked, strided elements, and from those to numbers.
#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "lodestone/base/parallel.h"
#include "lodestone/io/gltf/gltf_detail.h"

namespace lodestone::io {

std::optional<ComponentType> component_type(std::uint64_t number) {
  switch (number) {
    case 5120:
      return ComponentType::int8;
    case 5121:
      return ComponentType::uint8;
    case 5122:
      return ComponentType::int16;
    case 5123:
      return ComponentType::uint16;
    case 5125:
      return ComponentType::uint32;
    case 5126:
      return ComponentType::float32;
    default:
      return std::nullopt;
  }
}

unsigned gltf_number(ComponentType type) {
  switch (type) {
    case ComponentType::int8:
      return 5120;
    case ComponentType::uint8:
      return 5121;
    case ComponentType::int16:
      return 5122;
    case ComponentType::uint16:
      return 5123;
    case ComponentType::uint32:
      return 5125;
    default:
      return 5126;
  }
}

std::size_t components_of(std::string_view type) {
  if (type == "SCALAR") return 1;
  if (type == "VEC2") return 2;
  if (type == "VEC3") return 3;
  if (type == "VEC4" || type == "MAT2") return 4;
  if (type == "MAT3") return 9;
  if (type == "MAT4") return 16;
  return 0;
}

namespace {

constexpr std::size_t kChunk = std::size_t{1} << 16;

// Columns of matrices start at multiples of 4 bytes.
std::size_t element_bytes(std::string_view type, std::size_t component) {
  if (type == "MAT2") return component == 1 ? 8 : 4 * component;
  if (type == "MAT3") return component == 1 ? 12 : component == 2 ? 24 : 9 * component;
  return components_of(type) * component;
}

// `count` elements from `offset` on in view `view`.
Result<ByteSpan> elements(const Document::Data& data, const Json& holder, std::uint64_t count, std::size_t size,
                          bool use_stride, std::size_t& stride, const std::string& where) {
  const Result<std::size_t> view_index = index_member(holder, "bufferView", data.views.size(), "buffer views", where);
  LODESTONE_TRY(view_index);
  const View& view = data.views[*view_index];
  const Result<std::uint64_t> offset = uint_member(holder, "byteOffset", 0, where);
  LODESTONE_TRY(offset);
  stride = use_stride && view.stride != 0 ? view.stride : size;
  if (stride < size) {
    return fail(ErrorCode::bad_format,
                fmt::format("elements of {} bytes are in buffer view {} with byteStride {}", size, *view_index, stride),
                where);
  }
  const std::size_t there = view.bytes.size();
  const bool fits = *offset <= there && count <= there && (count - 1) * stride + size <= there - *offset;
  if (!fits) {
    return fail(ErrorCode::bad_format,
                fmt::format("{} elements of {} bytes from byte {} on do not fit buffer view {} of {} bytes", count,
                            size, *offset, *view_index, there),
                where, "is the file cut off?");
  }
  return view.bytes.subspan(static_cast<std::size_t>(*offset));
}

template <class T>
T load(const std::byte* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

std::uint32_t load_index(const std::byte* at, ComponentType type) {
  if (type == ComponentType::uint8) return load<std::uint8_t>(at);
  if (type == ComponentType::uint16) return load<std::uint16_t>(at);
  return load<std::uint32_t>(at);
}

// Replaces the elements that the sparse part names. `dense` is tight.
Result<void> apply_sparse(const Document::Data& data, const Json& sparse, std::uint64_t count, std::size_t size,
                          std::vector<std::byte>& dense, const std::string& where) {
  const Result<std::uint64_t> replaced = uint_member(sparse, "count", 0, where);
  LODESTONE_TRY(replaced);
  if (*replaced == 0) return {};
  if (*replaced > count) {
    return fail(ErrorCode::bad_format, fmt::format("sparse.count is {}, the accessor has {}", *replaced, count), where);
  }
  const Json* indices = member(sparse, "indices");
  const Json* values = member(sparse, "values");
  if (indices == nullptr || values == nullptr) {
    return fail(ErrorCode::bad_format, "sparse lacks indices or values", where);
  }
  const Result<std::uint64_t> number = uint_member(*indices, "componentType", 0, where);
  LODESTONE_TRY(number);
  const std::optional<ComponentType> type = component_type(*number);
  if (!type || (*type != ComponentType::uint8 && *type != ComponentType::uint16 && *type != ComponentType::uint32)) {
    return fail(ErrorCode::bad_format, fmt::format("sparse index componentType {} is not allowed", *number), where);
  }
  std::size_t index_stride = 0, value_stride = 0;
  const Result<ByteSpan> index_bytes = elements(data, *indices, *replaced, size_of(*type), false, index_stride, where);
  LODESTONE_TRY(index_bytes);
  const Result<ByteSpan> value_bytes = elements(data, *values, *replaced, size, false, value_stride, where);
  LODESTONE_TRY(value_bytes);
  for (std::size_t i = 0; i < *replaced; ++i) {
    const std::uint32_t target = load_index(index_bytes->data() + i * index_stride, *type);
    if (target >= count) {
      return fail(ErrorCode::bad_format, fmt::format("sparse index {} is {}, the accessor has {}", i, target, count),
                  where);
    }
    std::memcpy(dense.data() + target * size, value_bytes->data() + i * value_stride, size);
  }
  return {};
}

// What one component of the type stands for as a float.
template <class T>
float to_number(T value, bool normalized) {
  if constexpr (std::is_same_v<T, float>) {
    return value;
  } else {
    constexpr float top = static_cast<float>(std::numeric_limits<T>::max());
    const float number = static_cast<float>(value);
    return normalized ? std::max(number / top, -1.0f) : number;
  }
}

template <class Out, class Convert>
void gather_elements(const Accessor& a, std::span<const std::uint32_t> ids, std::size_t count, Out* out,
                     std::size_t out_components, Out missing, const Task& task, Convert convert) {
  const std::size_t component = size_of(a.type), common = std::min(a.components, out_components);
  parallel_for(count, kChunk, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::byte* element = a.data + (ids.empty() ? i : ids[i]) * a.stride;
      Out* to = out + i * out_components;
      for (std::size_t c = 0; c < common; ++c) to[c] = convert(element + c * component);
      for (std::size_t c = common; c < out_components; ++c) to[c] = missing;
    }
  });
}

// Calls `use` with a null pointer of the accessor's component type.
template <class Use>
void with_type(ComponentType type, Use use) {
  switch (type) {
    case ComponentType::int8:
      return use(static_cast<std::int8_t*>(nullptr));
    case ComponentType::uint8:
      return use(static_cast<std::uint8_t*>(nullptr));
    case ComponentType::int16:
      return use(static_cast<std::int16_t*>(nullptr));
    case ComponentType::uint16:
      return use(static_cast<std::uint16_t*>(nullptr));
    case ComponentType::int32:
      return use(static_cast<std::int32_t*>(nullptr));
    case ComponentType::uint32:
      return use(static_cast<std::uint32_t*>(nullptr));
    default:
      return use(static_cast<float*>(nullptr));
  }
}

}  // namespace

Result<Accessor> find_accessor(const Document::Data& data, std::size_t index, Budget* budget) {
  const Json& json = array_member(data.json, "accessors")[index];
  Accessor out;
  out.index = index;
  out.where = place(data, "accessor", index);
  const auto bad = [&](std::string what, std::string remedy = {}) {
    return fail(ErrorCode::bad_format, std::move(what), out.where, std::move(remedy));
  };
  const Result<std::uint64_t> count = uint_member(json, "count", 0, out.where);
  LODESTONE_TRY(count);
  const Result<std::uint64_t> number = uint_member(json, "componentType", 0, out.where);
  LODESTONE_TRY(number);
  const std::optional<ComponentType> type = component_type(*number);
  if (!type) return bad(fmt::format("componentType {} is unknown", *number));
  const std::string shape = string_member(json, "type");
  out.components = components_of(shape);
  if (out.components == 0) return bad(fmt::format("type '{}' is unknown", shape));
  if (*count == 0) return bad("count is 0 or missing");
  if (*count >= kNone) return bad(fmt::format("count {} is above 2^32 - 2", *count));
  const Json* normalized = member(json, "normalized");
  out.type = *type;
  out.normalized = normalized != nullptr && normalized->is_boolean() && normalized->get<bool>() &&
                   *type != ComponentType::float32 && *type != ComponentType::uint32;
  const std::size_t size = element_bytes(shape, size_of(*type));
  const Json* sparse = member(json, "sparse");
  if (const Json* view = member(json, "bufferView"); view != nullptr) {
    const Result<ByteSpan> bytes = elements(data, json, *count, size, true, out.stride, out.where);
    LODESTONE_TRY(bytes);
    out.data = bytes->data();
  } else if (*count > data.file_bytes) {
    return bad(fmt::format("{} elements without a buffer view, the file has {} bytes", *count, data.file_bytes));
  }
  out.count = static_cast<std::size_t>(*count);
  if (out.data == nullptr || sparse != nullptr) {
    if (budget != nullptr && !budget->take(out.count * size)) return unfolds_too_far(data, "the accessors", out.where);
    auto dense = std::make_shared<std::vector<std::byte>>(out.count * size);
    for (std::size_t i = 0; out.data != nullptr && i < out.count; ++i) {
      std::memcpy(dense->data() + i * size, out.data + i * out.stride, size);
    }
    if (sparse != nullptr) {
      if (const auto good = apply_sparse(data, *sparse, *count, size, *dense, out.where); !good)
        return fail(good.error());
    }
    out.data = dense->data();
    out.stride = size;
    out.own = std::move(dense);
  }
  return out;
}

namespace {

// What is stored as it is wanted, without gaps and choice, is copied as a whole.
template <class Out>
bool copy_plain(const Accessor& a, ComponentType wanted, std::span<const std::uint32_t> ids, std::size_t count,
                Out* out, std::size_t out_components) {
  const std::size_t bytes = out_components * sizeof(Out);
  if (a.type != wanted || a.components != out_components || a.stride != bytes || !ids.empty()) return false;
  std::memcpy(out, a.data, count * bytes);
  return true;
}

}  // namespace

void gather(const Accessor& accessor, std::span<const std::uint32_t> ids, std::size_t count, float* out,
            std::size_t out_components, float missing, const Task& task) {
  if (copy_plain(accessor, ComponentType::float32, ids, count, out, out_components)) return;
  with_type(accessor.type, [&](auto* null) {
    using T = std::remove_pointer_t<decltype(null)>;
    gather_elements(accessor, ids, count, out, out_components, missing, task,
                    [&](const std::byte* at) { return to_number(load<T>(at), accessor.normalized); });
  });
}

void gather_bits(const Accessor& accessor, std::span<const std::uint32_t> ids, std::size_t count, std::uint32_t* out,
                 std::size_t out_components, const Task& task) {
  if (copy_plain(accessor, ComponentType::uint32, ids, count, out, out_components)) return;
  with_type(accessor.type, [&](auto* null) {
    using T = std::remove_pointer_t<decltype(null)>;
    gather_elements(accessor, ids, count, out, out_components, std::uint32_t{0}, task, [&](const std::byte* at) {
      const T value = load<T>(at);
      if constexpr (std::is_same_v<T, float>) {
        return load<std::uint32_t>(at);
      } else {
        return static_cast<std::uint32_t>(value);
      }
    });
  });
}

}  // namespace lodestone::io
