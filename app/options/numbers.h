// Numbers as people type them: counts with thousands, and commas that were meant as decimal points.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lodestone::app {

/// "a,b,c" -> {"a", "b", "c"}
std::vector<std::string> split_commas(std::string_view text);

struct Count {
  std::uint64_t value = 0;
  bool too_large = false;  ///< above 2^64 - 1; `value` means nothing then
};

/// A whole number: "5000", "5,000", "5k", "1.5M", "2G", "1e4"; k, M and G are powers of 1000. Nothing for any other
/// text and for what is no whole number.
std::optional<Count> count_in(std::string_view text);

/// What a list of values parted by commas says if one of its commas was meant as a decimal point: "0,1%" gives "0.1%",
/// "1,5mm" gives "1.5mm". Empty where all commas part values.
std::string with_decimal_point(std::string_view list);

/// What a list of counts says if its commas were meant as those of thousands: "20,000,5,000" gives "20000,5000". Empty
/// where they part values.
std::string without_thousands(std::string_view list);

}  // namespace lodestone::app
