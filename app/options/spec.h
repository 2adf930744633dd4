// The one definition of verbs and options. The parser, help, man page and completions are all made from it.
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "app/exit_code.h"
#include "lodestone/base/result.h"

namespace lodestone::app {

class Arguments;
class Console;

/// What a shell offers after an option or as an input.
enum class Completion { none, choices, file, directory };

struct OptionSpec {
  std::string name;                  ///< "--levels"
  std::string short_name;            ///< "-o"; empty = none
  std::string value;                 ///< placeholder: "N"; empty = a switch
  std::string default_value;         ///< as it would be typed; empty = none
  std::string unit;                  ///< "pixels"; empty = none
  std::string text;                  ///< what it does, a clause without full stop
  std::vector<std::string> choices;  ///< the only values allowed; empty = free
  Completion completion = Completion::none;

  bool is_switch() const { return value.empty(); }
};

struct OptionGroup {
  std::string title;
  std::vector<OptionSpec> options;
};

struct Example {
  std::string command;  ///< runs as it stands (a test does so)
  std::string text;     ///< what it does
};

struct InputSpec {
  std::string usage;  ///< "INPUT..."
  std::size_t least = 1, most = 1;
  std::vector<std::string> choices;
  Completion completion = Completion::file;
};

using VerbFunction = Result<ExitCode> (*)(const Arguments&, Console&);

struct VerbSpec {
  std::string name;
  std::string summary;  ///< one sentence
  InputSpec inputs;
  std::vector<OptionGroup> groups;
  std::vector<Example> examples;
  std::string notes;  ///< further paragraphs for help and man page; may be empty
  VerbFunction run = nullptr;
};

inline constexpr std::size_t kAnyNumber = std::numeric_limits<std::size_t>::max();

/// All verbs, in the order of the help.
const std::vector<VerbSpec>& verbs();

/// Null when there is none of that name.
const VerbSpec* find_verb(std::string_view name);
/// By long or short name; null when the verb has no such option.
const OptionSpec* find_option(const VerbSpec& verb, std::string_view name);

/// What the exit codes mean, for help and man page.
const std::vector<Example>& exit_codes();

}  // namespace lodestone::app
