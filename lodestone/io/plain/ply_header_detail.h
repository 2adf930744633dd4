// The header of a PLY file.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "lodestone/base/result.h"
#include "lodestone/core/attributes.h"
#include "lodestone/io/byte_reader_detail.h"

namespace lodestone::io {

enum class PlyFormat { ascii, binary_little_endian, binary_big_endian };

struct PlyProperty {
  std::string name;
  ComponentType type = ComponentType::float32;  ///< of the value, or of a list's items
  bool is_list = false;
  ComponentType count_type = ComponentType::uint8;  ///< of a list's length
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::uint64_t line = 0;  ///< of the header
  std::vector<PlyProperty> properties;

  /// Index of a property, or -1.
  int find(std::string_view property) const;
  bool has_lists() const;
  /// The fewest bytes that one record can take in the file.
  std::uint64_t smallest_record(PlyFormat format) const;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::ascii;
  std::vector<PlyElement> elements;
  std::vector<std::string> textures;  ///< of "comment TextureFile name"
  std::uint64_t data_begin = 0;       ///< byte after the header
  std::uint64_t lines = 0;            ///< how many it has

  const PlyElement* find(std::string_view element) const;
};

/// Reads up to the first byte of data. Counts are checked against the file's size. Errors: bad_format with the line.
Result<PlyHeader> read_ply_header(ByteReader& bytes);

}  // namespace lodestone::io
