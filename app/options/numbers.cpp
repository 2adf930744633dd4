#include "app/options/numbers.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "lodestone/base/units.h"

namespace lodestone::app {
namespace {

bool all_digits(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

// "000" and "125" after a comma.
bool three_digits(std::string_view text) { return text.size() == 3 && all_digits(text); }

Count whole_in(std::string_view digits) {
  Count out;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), out.value);
  out.too_large = error != std::errc{};
  return out;
}

// "5,000" and "1,234,567"; empty for any other text.
std::string joined_thousands(std::string_view text) {
  const std::vector<std::string> groups = split_commas(text);
  if (groups.size() < 2 || groups[0].size() > 3 || groups[0].starts_with('0') || !all_digits(groups[0])) return {};
  if (!std::all_of(groups.begin() + 1, groups.end(), three_digits)) return {};
  std::string digits;
  for (const std::string& group : groups) digits += group;
  return digits;
}

double power_of(char letter) {
  switch (letter) {
    case 'k':
    case 'K':
      return 1e3;
    case 'M':
      return 1e6;
    case 'G':
      return 1e9;
    default:
      return 1;
  }
}

}  // namespace

std::vector<std::string> split_commas(std::string_view text) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  while (true) {
    const std::size_t comma = text.find(',', begin);
    parts.emplace_back(text.substr(begin, comma - begin));
    if (comma == std::string_view::npos) return parts;
    begin = comma + 1;
  }
}

std::optional<Count> count_in(std::string_view text) {
  if (all_digits(text)) return whole_in(text);
  if (const std::string digits = joined_thousands(text); !digits.empty()) return whole_in(digits);
  if (text.empty()) return std::nullopt;
  const double power = power_of(text.back());
  if (power != 1) text.remove_suffix(1);
  const std::optional<double> number = parse_number(text);
  if (!number || *number < 0) return std::nullopt;
  const double value = std::round(*number * power);
  if (std::abs(*number * power - value) > 1e-9 * value) return std::nullopt;  // 1.1k is whole but for its rounding
  if (value >= 0x1p64) return Count{0, true};
  return Count{static_cast<std::uint64_t>(value), false};
}

std::string with_decimal_point(std::string_view list) {
  const std::vector<std::string> words = split_commas(list);
  std::string out;
  bool meant = false;
  for (std::size_t i = 0; i < words.size(); ++i) {
    out += (i == 0 ? "" : ",") + words[i];
    if (i + 1 == words.size() || !all_digits(words[i])) continue;
    // A value of 0, or one without the unit of the next, is none that anybody asks for.
    const std::string& next = words[i + 1];
    const std::size_t digits = std::min(next.find_first_not_of("0123456789"), next.size());
    const std::string_view unit = std::string_view(next).substr(digits);
    const bool has_unit = !unit.empty() && unit.find_first_of(".eE") == std::string_view::npos;
    if (digits == 0 || (!has_unit && (!unit.empty() || words[i].find_first_not_of('0') != std::string::npos))) continue;
    out += '.' + next;
    meant = true;
    ++i;
  }
  return meant ? out : std::string();
}

std::string without_thousands(std::string_view list) {
  const std::vector<std::string> words = split_commas(list);
  std::string out, value;  // `value` is what groups may still be joined to
  bool meant = false;
  for (const std::string& word : words) {
    // Counts fall along a ladder, so "5,000" and "12,500" are none of two levels.
    const bool joins = three_digits(word) && all_digits(value) &&
                       (word.front() == '0' || (value.size() <= 3 && whole_in(word).value > whole_in(value).value));
    if (!joins && !value.empty()) out += value + ',';
    value = joins ? value + word : word;
    meant = meant || joins;
  }
  return meant ? out + value : std::string();
}

}  // namespace lodestone::app
