// From argv to values, by the definitions in spec.h.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "app/options/numbers.h"
#include "app/options/spec.h"

namespace lodestone::app {

/// The parsed command line of one verb.
class Arguments {
 public:
  const VerbSpec* verb = nullptr;
  std::vector<std::string> inputs;
  std::map<std::string, std::string, std::less<>> given;  ///< long option name -> text; switches have an empty text

  bool has(std::string_view option) const { return given.find(option) != given.end(); }
  /// What was typed, else the option's default.
  std::string text(std::string_view option) const;
  /// A whole number from `least` to `most`. Errors: bad_argument.
  Result<std::uint64_t> count(std::string_view option, std::uint64_t least = 0,
                              std::uint64_t most = std::numeric_limits<std::uint64_t>::max()) const;
  /// A finite number above 0. Errors: bad_argument.
  Result<double> positive(std::string_view option) const;
  /// Whole numbers of at least 1, separated by commas. Errors: bad_argument.
  Result<std::vector<std::size_t>> count_list(std::string_view option) const;
};

/// Parses what follows the verb. Errors: bad_argument, with the nearest name for an unknown option.
Result<Arguments> parse_arguments(const VerbSpec& verb, const std::vector<std::string>& words);

/// What to say about "0,1%", where `meant` is "0.1%".
Error decimal_comma(std::string_view option, std::string_view text, std::string_view meant);

}  // namespace lodestone::app
