// Lengths as users write them, and numbers as people read them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "lodestone/base/result.h"

namespace lodestone {

/// A unit of length that users write.
struct LengthUnit {
  std::string_view name;
  double metres;
};
inline constexpr LengthUnit kLengthUnits[] = {{"um", 1e-6}, {"mm", 1e-3},   {"cm", 1e-2},   {"dm", 0.1},
                                              {"m", 1.0},   {"km", 1000.0}, {"in", 0.0254}, {"ft", 0.3048}};

/// A length as given on a command line. Relative: a fraction of the bounding box's diagonal ("0.001", "0.1%").
/// Absolute: metres ("2mm" = 0.002), to be turned into model units by the model's own unit.
struct Length {
  double value = 0;
  enum class Kind { relative, metres } kind = Kind::relative;
};

/// A number that a text begins with, and what follows it.
struct LeadingNumber {
  double value = 0;
  std::string_view rest;
};
/// The longest finite decimal number at the head of the text, written with a point whatever the locale; nothing where
/// there is none. Neither blanks nor a "+" may stand before it.
std::optional<LeadingNumber> leading_number(std::string_view text);

/// The whole of the text as a finite number, nothing for any other text.
std::optional<double> parse_number(std::string_view text);

/// Reads "0.001", "0.1%", "2mm", "0.5m", "3cm", "1km", "1in", "2ft". Must be finite and not negative.
Result<Length> parse_length(std::string_view text);

/// "1,234,567"
std::string with_separators(std::uint64_t value);
/// "3.4 MB" (powers of 1000)
std::string human_bytes(std::uint64_t bytes);
/// Four significant digits: "0.001234", "12.35", "1.2e-07".
std::string short_number(double value);
/// A share as "12.5 %".
std::string percent(double share);

}  // namespace lodestone
