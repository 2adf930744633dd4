// What a program started by the command says to it over a pipe: lines of "key value", and at the end that it is done or
// which error it met. Used on both sides.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lodestone/base/result.h"

namespace lodestone::app {

/// Where a child finds the pipe for what it has to say.
inline constexpr int kReportDescriptor = 3;

/// Writes a line; line ends in the value become spaces. The process ends when nobody listens any more.
void say(std::string_view key, std::string_view value = {});
/// The last lines of a child that went well, and of one that didn't.
void say_done();
void say_failed(const Error& error);

struct ChildReport {
  std::vector<std::pair<std::string, std::string>> lines;  ///< key and value, in the order that they were said
  bool done = false, failed = false;                       ///< neither: the child ended before its report did
  Error error;                                             ///< where failed

  /// The first value of a key; empty when it was not said.
  std::string value(std::string_view key) const;
  std::vector<std::string> values(std::string_view key) const;
  /// The numbers of a value, with spaces between them; what is no number ends them.
  std::vector<double> numbers(std::string_view key) const;
  /// The first of them, 0 without one.
  double number(std::string_view key) const;
};
ChildReport parse_child_report(std::string_view text);

}  // namespace lodestone::app
