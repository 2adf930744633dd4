#include "lodestone/base/units.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace lodestone {

std::optional<LeadingNumber> leading_number(std::string_view text) {
  double value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || !std::isfinite(value)) return std::nullopt;
  return LeadingNumber{value, text.substr(static_cast<std::size_t>(stop - text.data()))};
}

std::optional<double> parse_number(std::string_view text) {
  const std::optional<LeadingNumber> number = leading_number(text);
  if (!number || !number->rest.empty()) return std::nullopt;
  return number->value;
}

Result<Length> parse_length(std::string_view text) {
  const std::optional<LeadingNumber> read = leading_number(text);
  const auto bad = [&](std::string_view why) {
    return fail(ErrorCode::bad_argument, fmt::format("'{}' {}", text, why), {},
                "write 0.001 or 0.1% (of the diagonal) or a length such as 2mm, 0.5m");
  };
  if (!read) return bad("is not a length");
  const auto [number, unit] = *read;
  if (number < 0) return bad("is not a finite length of at least 0");
  if (unit.empty()) return Length{number, Length::Kind::relative};
  if (unit == "%") return Length{number / 100.0, Length::Kind::relative};
  for (const LengthUnit& u : kLengthUnits) {
    if (unit == u.name) return Length{number * u.metres, Length::Kind::metres};
  }
  return bad("has a unit we don't know");
}

std::string with_separators(std::uint64_t value) {
  std::string digits = std::to_string(value);
  for (std::size_t i = digits.size(); i > 3; i -= 3) digits.insert(i - 3, 1, ',');
  return digits;
}

std::string human_bytes(std::uint64_t bytes) {
  if (bytes < 1000) return fmt::format("{} B", bytes);
  constexpr const char* kNames[] = {"kB", "MB", "GB", "TB", "PB", "EB"};
  double value = static_cast<double>(bytes) / 1000.0;
  std::size_t i = 0;
  while (value >= 999.5 && i + 1 < std::size(kNames)) {
    value /= 1000.0;
    ++i;
  }
  return fmt::format("{:.{}f} {}", value, value < 9.95 ? 1 : 0, kNames[i]);
}

std::string short_number(double value) { return fmt::format("{:.4g}", value); }

std::string percent(double share) { return fmt::format("{:.3g} %", share * 100); }

}  // namespace lodestone
