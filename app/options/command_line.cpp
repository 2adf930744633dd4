#include "app/options/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>

#include "app/options/numbers.h"
#include "app/options/suggest.h"
#include "lodestone/base/units.h"

namespace lodestone::app {
namespace {

Error usage_error(const VerbSpec& verb, std::string what) {
  return Error{ErrorCode::bad_argument, std::move(what), {}, fmt::format("see 'lod help {}'", verb.name)};
}

tl::unexpected<Error> bad_value(std::string_view option, std::string_view text, std::string_view wanted) {
  return fail(ErrorCode::bad_argument, fmt::format("{} is '{}', but {}", option, text, wanted));
}

Result<std::uint64_t> parse_count(std::string_view option, std::string_view text, std::uint64_t least,
                                  std::uint64_t most = std::numeric_limits<std::uint64_t>::max()) {
  const std::optional<Count> count = count_in(text);
  if (count && (count->too_large || count->value > most)) {
    return fail(ErrorCode::bad_argument, fmt::format("{} is {}, the limit is {}", option, text, with_separators(most)));
  }
  if (!count || count->value < least) {
    return bad_value(option, text, fmt::format("it must be a whole number of at least {}", least));
  }
  return count->value;
}

// What CLI11 fills; strings must not move while it holds their addresses.
struct Slot {
  const OptionSpec* spec;
  std::string text;
  bool set = false;
  CLI::Option* option = nullptr;
};

void add_option(CLI::App& parser, Slot& slot) {
  const OptionSpec& spec = *slot.spec;
  const std::string names = spec.short_name.empty() ? spec.name : spec.short_name + "," + spec.name;
  if (spec.is_switch()) {
    slot.option = parser.add_flag(names, slot.set);
  } else {
    slot.option = parser.add_option(names, slot.text)->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  }
}

// A word too many: most often an output as other programs take it, without -o.
Error surplus_input(const VerbSpec& verb, const std::string& word, bool has_output) {
  if (verb.inputs.most == 0) return usage_error(verb, fmt::format("{} takes no input, but got '{}'", verb.name, word));
  std::string what = fmt::format("{} takes {}, '{}' is one too many", verb.name, verb.inputs.usage, word);
  if (has_output || find_option(verb, "--output") == nullptr) return usage_error(verb, std::move(what));
  return Error{ErrorCode::bad_argument, std::move(what), {}, fmt::format("to write {}, use -o {}", word, word)};
}

Error unknown_option(const VerbSpec& verb, const std::string& word) {
  std::vector<std::string> names;
  for (const OptionGroup& group : verb.groups) {
    for (const OptionSpec& option : group.options) names.push_back(option.name);
  }
  const std::string name = word.substr(0, word.find('='));
  return usage_error(verb, fmt::format("{} has no option '{}'{}", verb.name, name, did_you_mean(name, names)));
}

Result<void> check_choice(const VerbSpec& verb, const std::string& what, const std::string& text,
                          const std::vector<std::string>& choices) {
  if (choices.empty() || std::find(choices.begin(), choices.end(), text) != choices.end()) return {};
  return fail(usage_error(
      verb, fmt::format("{} '{}' is none of {}{}", what, text, fmt::join(choices, ", "), did_you_mean(text, choices))));
}

Result<void> check_inputs(const VerbSpec& verb, const std::vector<std::string>& inputs) {
  if (inputs.size() < verb.inputs.least) {
    return fail(usage_error(verb, fmt::format("{} needs {}, got {}", verb.name, verb.inputs.usage,
                                              inputs.empty() ? "none" : fmt::format("{}", inputs.size()))));
  }
  for (const std::string& input : inputs) {
    if (input.empty()) return fail(usage_error(verb, "an input is the empty word"));
    LODESTONE_TRY(check_choice(verb, verb.inputs.usage, input, verb.inputs.choices));
  }
  return {};
}

// What the parser can't take: an option at the end that needs a value. Its own words are for programmers.
Error parse_error(const VerbSpec& verb, const std::vector<std::string>& words) {
  const OptionSpec* last = words.empty() ? nullptr : find_option(verb, words.back());
  if (last == nullptr || last->is_switch()) return usage_error(verb, "the command line can't be read");
  return usage_error(verb, fmt::format("{} needs a value: {}", words.back(), last->value));
}

// "--json=yes"
Result<void> check_switches(const VerbSpec& verb, const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    if (word == "--") break;
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos || !word.starts_with("--")) continue;
    const OptionSpec* option = find_option(verb, std::string_view(word).substr(0, equals));
    if (option != nullptr && option->is_switch()) {
      return fail(usage_error(verb, fmt::format("{} takes no value, but got '{}'", option->name, word)));
    }
  }
  return {};
}

}  // namespace

std::string Arguments::text(std::string_view option) const {
  if (const auto found = given.find(option); found != given.end()) return found->second;
  const OptionSpec* spec = find_option(*verb, option);
  return spec ? spec->default_value : std::string();
}

Result<std::uint64_t> Arguments::count(std::string_view option, std::uint64_t least, std::uint64_t most) const {
  return parse_count(option, text(option), least, most);
}

Result<double> Arguments::positive(std::string_view option) const {
  const std::string word = text(option);
  const std::optional<double> value = parse_number(word);
  if (const std::string meant = with_decimal_point(word); !value && !meant.empty()) {
    return fail(decimal_comma(option, word, meant));
  }
  if (!value || *value <= 0) return bad_value(option, word, "it must be a number above 0");
  return *value;
}

Result<std::vector<std::size_t>> Arguments::count_list(std::string_view option) const {
  std::vector<std::size_t> values;
  if (const std::string meant = without_thousands(text(option)); !meant.empty()) {
    return fail(ErrorCode::bad_argument, fmt::format("{} is '{}', but commas separate values", option, text(option)),
                {}, fmt::format("write {}", meant));
  }
  for (const std::string& word : split_commas(text(option))) {
    const Result<std::uint64_t> value = parse_count(option, word, 1);
    LODESTONE_TRY(value);
    values.push_back(*value);
  }
  return values;
}

Result<Arguments> parse_arguments(const VerbSpec& verb, const std::vector<std::string>& words) {
  CLI::App parser;
  parser.set_help_flag();
  parser.allow_extras();
  std::vector<Slot> slots;
  for (const OptionGroup& group : verb.groups) {
    for (const OptionSpec& option : group.options) slots.push_back(Slot{&option, {}, false, nullptr});
  }
  for (Slot& slot : slots) add_option(parser, slot);

  Arguments out;
  out.verb = &verb;
  LODESTONE_TRY(check_switches(verb, words));
  // CLI11 parses from the back of its vector. Inputs are what it leaves over: a verb's inputs may stand anywhere.
  std::vector<std::string> reversed(words.rbegin(), words.rend());
  try {
    parser.parse(reversed);
  } catch (const CLI::ParseError&) {
    return fail(parse_error(verb, words));
  }
  for (Slot& slot : slots) {
    if (slot.option->count() == 0) continue;
    if (slot.option->count() > 1 && !slot.spec->is_switch()) {
      return fail(usage_error(verb, fmt::format("{} is given {} times", slot.spec->name, slot.option->count())));
    }
    LODESTONE_TRY(check_choice(verb, slot.spec->name, slot.text, slot.spec->choices));
    out.given.emplace(slot.spec->name, std::move(slot.text));
  }
  bool only_inputs = false;  // after "--" even words with a dash are inputs
  for (const std::string& word : parser.remaining()) {
    if (word == "--" && !only_inputs) {
      only_inputs = true;
      continue;
    }
    const bool looks_like_option = !only_inputs && word.size() > 1 && word[0] == '-';
    if (looks_like_option) return fail(unknown_option(verb, word));
    if (out.inputs.size() >= verb.inputs.most && !out.has("--help")) {
      return fail(surplus_input(verb, word, out.has("--output")));
    }
    out.inputs.push_back(word);
  }
  if (out.has("--help")) return out;
  LODESTONE_TRY(check_inputs(verb, out.inputs));
  return out;
}

Error decimal_comma(std::string_view option, std::string_view text, std::string_view meant) {
  return Error{ErrorCode::bad_argument,
               fmt::format("{} is '{}', but commas separate values", option, text),
               {},
               fmt::format("write {} with a decimal point, or give each value its unit", meant)};
}

}  // namespace lodestone::app
