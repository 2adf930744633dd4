// The header of a PCD file.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lodestone/base/result.h"
#include "lodestone/io/byte_reader_detail.h"

namespace lodestone::io {

enum class PcdData { ascii, binary, binary_compressed };

/// What of a point a field is.
enum class PcdRole { x, y, z, normal_x, normal_y, normal_z, rgb, rgba, red, green, blue, other };

struct PcdField {
  std::string name;
  PcdRole role = PcdRole::other;
  char type = 'F';           ///< F, I or U
  std::uint32_t size = 4;    ///< bytes of a number: 1, 2, 4, 8
  std::uint32_t count = 1;   ///< numbers
  std::uint64_t offset = 0;  ///< in a record
};

struct PcdHeader {
  std::vector<PcdField> fields;  ///< x, y and z are among them; of each role but `other` at most one
  std::uint64_t points = 0;
  std::uint64_t record_bytes = 0;
  std::uint64_t numbers = 0;  ///< of a record
  PcdData data = PcdData::ascii;
  std::uint64_t data_begin = 0;  ///< byte after the header
  std::uint64_t lines = 0;       ///< how many it has

  bool has(PcdRole role) const {
    for (const PcdField& f : fields) {
      if (f.role == role) return true;
    }
    return false;
  }
};

/// Errors: bad_format with the line, unsupported (sizes and kinds that numbers don't have).
Result<PcdHeader> read_pcd_header(ByteReader& bytes);

}  // namespace lodestone::io
