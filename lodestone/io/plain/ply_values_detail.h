// PlyValues: the data of a PLY file as numbers one after another, whatever their coding.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>

#include "lodestone/core/attributes.h"
#include "lodestone/io/plain/ply_header_detail.h"
#include "lodestone/io/text_reader_detail.h"

namespace lodestone::io {

static_assert(std::endian::native == std::endian::little, "binary files are read and written as little-endian");

/// A number of the file, its bytes turned around where `swap` says so.
template <class T, bool swap>
T load_number(const char* from) {
  unsigned char bytes[sizeof(T)];
  std::memcpy(bytes, from, sizeof(T));
  if constexpr (swap) {
    for (std::size_t i = 0; i < sizeof(T) / 2; ++i) {
      const unsigned char b = bytes[i];
      bytes[i] = bytes[sizeof(T) - 1 - i];
      bytes[sizeof(T) - 1 - i] = b;
    }
  }
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return value;
}

/// Calls f with a value of the C++ type that stands for `type`.
template <class F>
decltype(auto) with_type(ComponentType type, F&& f) {
  switch (type) {
    case ComponentType::int8:
      return f(std::int8_t{});
    case ComponentType::uint8:
      return f(std::uint8_t{});
    case ComponentType::int16:
      return f(std::int16_t{});
    case ComponentType::uint16:
      return f(std::uint16_t{});
    case ComponentType::int32:
      return f(std::int32_t{});
    case ComponentType::uint32:
      return f(std::uint32_t{});
    case ComponentType::float64:
      return f(double{});
    case ComponentType::float32:
      break;
  }
  return f(float{});
}

class PlyValues {
 public:
  PlyValues(ByteReader& bytes, const PlyHeader& header)
      : bytes_(bytes), format_(header.format), text_(bytes, 0, header.lines + 1) {}

  /// The next number. False: the file ends here or has something else; error() says which.
  bool next(ComponentType type, double& value) {
    if (format_ == PlyFormat::ascii) return next_in_text(type, value);
    if (!bytes_.ensure(size_of(type))) return false;
    value = with_type(type, [&](auto zero) {
      using T = decltype(zero);
      return static_cast<double>(format_ == PlyFormat::binary_big_endian ? load_number<T, true>(bytes_.data())
                                                                         : load_number<T, false>(bytes_.data()));
    });
    bytes_.skip(size_of(type));
    return true;
  }

  /// The length of a list, which the rest of the file can hold. False: it cannot, or as next().
  bool next_count(const PlyProperty& list, std::uint64_t& count);
  /// Steps over a property's value or list.
  bool skip(const PlyProperty& property);

  /// The error after a false, `what` being read: "face 12 of 168".
  Error error(std::string what) const;
  /// "file.ply:14" in text, "file.ply: byte 213" in binary: where the last number stands.
  std::string place() const;
  ByteReader& bytes() { return bytes_; }
  bool is_text() const { return format_ == PlyFormat::ascii; }
  bool is_swapped() const { return format_ == PlyFormat::binary_big_endian; }

 private:
  bool next_in_text(ComponentType type, double& value);
  ByteReader& bytes_;
  PlyFormat format_;
  TextReader text_;
  std::string complaint_;  // what was wrong if it was not the end of the file
};

}  // namespace lodestone::io
