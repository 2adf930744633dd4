#include <fmt/format.h>

#include <cmath>

#include "lodestone/io/plain/ply_values_detail.h"
#include "lodestone/io/read_detail.h"

namespace lodestone::io {

bool PlyValues::next_in_text(ComponentType type, double& value) {
  const std::string_view word = text_.word();
  if (word.empty()) return false;
  bool good = false;
  if (type == ComponentType::float32) {  // rounded once, as a float
    float single = 0;
    good = parse_number(word, single);
    value = static_cast<double>(single);
  } else if (type == ComponentType::float64) {
    good = parse_number(word, value);
  } else {
    std::int64_t integer = 0;
    good = parse_integer(word, integer);
    if (good) {
      value = static_cast<double>(integer);
    } else {
      good = parse_number(word, value);  // some write 255.0
    }
  }
  if (!good) complaint_ = fmt::format("'{}' is not a number", word.substr(0, 40));
  return good;
}

bool PlyValues::next_count(const PlyProperty& list, std::uint64_t& count) {
  double value = 0;
  if (!next(list.count_type, value)) return false;
  if (!(value >= 0) || value != std::floor(value)) {
    complaint_ = fmt::format("a list of {} items cannot be", value);
    return false;
  }
  const std::uint64_t each = is_text() ? 2 : size_of(list.type);
  const std::uint64_t left = bytes_.remaining() + (is_text() ? 1 : 0);
  if (value > static_cast<double>(left / each)) {
    complaint_ = fmt::format("a list of {} items needs {}, the file has {} left", fmt::format("{:.0f}", value),
                             size_text(value * static_cast<double>(each)), size_text(static_cast<double>(left)));
    return false;
  }
  count = static_cast<std::uint64_t>(value);
  return true;
}

bool PlyValues::skip(const PlyProperty& property) {
  double ignored = 0;
  if (!property.is_list) return next(property.type, ignored);
  std::uint64_t count = 0;
  if (!next_count(property, count)) return false;
  if (!is_text()) return bytes_.skip_far(count * size_of(property.type));
  for (std::uint64_t i = 0; i < count; ++i) {
    if (!next(property.type, ignored)) return false;
  }
  return true;
}

Error PlyValues::error(std::string what) const {
  if (const Result<void> status = bytes_.status(); !status) return status.error();
  if (!complaint_.empty()) {
    return {ErrorCode::bad_format, fmt::format("{} in {}", complaint_, what), place(),
            "is the file damaged or cut off?"};
  }
  return {ErrorCode::bad_format, fmt::format("the file ends in {}", what), place(), "is it cut off?"};
}

std::string PlyValues::place() const {
  return is_text() ? text_.place() : byte_place(bytes_.name(), bytes_.position());
}

}  // namespace lodestone::io
