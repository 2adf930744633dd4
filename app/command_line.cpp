#include "app/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>

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
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc::result_out_of_range || (error == std::errc{} && value > most)) {
    return fail(ErrorCode::bad_argument, fmt::format("{} is {}, the limit is {}", option, text, with_separators(most)));
  }
  if (error != std::errc{} || end != text.data() + text.size() || value < least) {
    return bad_value(option, text, fmt::format("it must be a whole number of at least {}", least));
  }
  return value;
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
    slot.option = parser.add_option(names, slot.text)->type_name(spec.value);
  }
}

Error unknown_word(const VerbSpec& verb, const std::string& word) {
  if (word.empty() || word[0] != '-' || word == "-") {
    return usage_error(verb, verb.inputs.most == 0 ? fmt::format("{} takes no input, but got '{}'", verb.name, word)
                                                   : fmt::format("{} takes {}, '{}' is one too many", verb.name,
                                                                 verb.inputs.usage, word));
  }
  std::vector<std::string> names;
  for (const OptionGroup& group : verb.groups) {
    for (const OptionSpec& option : group.options) names.push_back(option.name);
  }
  const std::string name = word.substr(0, word.find('='));
  return usage_error(verb,
                     fmt::format("{} has no option '{}', did you mean {}?", verb.name, name, nearest(name, names)));
}

Result<void> check_choice(const VerbSpec& verb, const std::string& what, const std::string& text,
                          const std::vector<std::string>& choices) {
  if (choices.empty() || std::find(choices.begin(), choices.end(), text) != choices.end()) return {};
  return fail(usage_error(verb, fmt::format("{} '{}' is none of {}, did you mean {}?", what, text,
                                            fmt::join(choices, ", "), nearest(text, choices))));
}

Result<void> check_inputs(const VerbSpec& verb, const std::vector<std::string>& inputs) {
  if (inputs.size() < verb.inputs.least) {
    return fail(usage_error(verb, fmt::format("{} needs {}, got {}", verb.name, verb.inputs.usage,
                                              inputs.empty() ? "none" : fmt::format("{}", inputs.size()))));
  }
  for (const std::string& input : inputs) {
    if (input.empty()) return fail(usage_error(verb, "an input is the empty word"));
    const Result<void> checked = check_choice(verb, verb.inputs.usage, input, verb.inputs.choices);
    if (!checked) return fail(checked.error());
  }
  return {};
}

Error parse_error(const VerbSpec& verb, const CLI::ParseError& error) {
  std::string what = error.what();
  std::replace(what.begin(), what.end(), '\n', ' ');
  return usage_error(verb, what);
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
  if (!value || *value <= 0) return bad_value(option, word, "it must be a number above 0");
  return *value;
}

Result<std::vector<std::size_t>> Arguments::count_list(std::string_view option) const {
  std::vector<std::size_t> values;
  for (const std::string& word : split_commas(text(option))) {
    const Result<std::uint64_t> value = parse_count(option, word, 1);
    if (!value) return fail(value.error());
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
  // CLI11 parses from the back of its vector. Inputs are what it leaves over: a verb's inputs may stand anywhere.
  std::vector<std::string> reversed(words.rbegin(), words.rend());
  try {
    parser.parse(reversed);
  } catch (const CLI::ParseError& error) {
    return fail(parse_error(verb, error));
  }
  for (Slot& slot : slots) {
    if (slot.option->count() == 0) continue;
    if (const Result<void> checked = check_choice(verb, slot.spec->name, slot.text, slot.spec->choices); !checked) {
      return fail(checked.error());
    }
    out.given.emplace(slot.spec->name, std::move(slot.text));
  }
  bool only_inputs = false;  // after "--" even words with a dash are inputs
  for (const std::string& word : parser.remaining()) {
    if (word == "--" && !only_inputs) {
      only_inputs = true;
      continue;
    }
    const bool looks_like_option = !only_inputs && word.size() > 1 && word[0] == '-';
    if (looks_like_option || (out.inputs.size() >= verb.inputs.most && !out.has("--help"))) {
      return fail(unknown_word(verb, word));
    }
    out.inputs.push_back(word);
  }
  if (out.has("--help")) return out;
  if (const Result<void> checked = check_inputs(verb, out.inputs); !checked) return fail(checked.error());
  return out;
}

std::string nearest(std::string_view word, const std::vector<std::string>& candidates) {
  std::string best;
  std::size_t best_edits = kAnyNumber;
  for (const std::string& candidate : candidates) {
    std::vector<std::size_t> row(candidate.size() + 1);
    for (std::size_t j = 0; j < row.size(); ++j) row[j] = j;
    for (std::size_t i = 0; i < word.size(); ++i) {
      std::size_t diagonal = row[0];
      row[0] = i + 1;
      for (std::size_t j = 1; j < row.size(); ++j) {
        const std::size_t above = row[j];
        row[j] = std::min({row[j] + 1, row[j - 1] + 1, diagonal + (word[i] == candidate[j - 1] ? 0 : 1)});
        diagonal = above;
      }
    }
    if (row.back() < best_edits) {
      best_edits = row.back();
      best = candidate;
    }
  }
  return best;
}

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

}  // namespace lodestone::app
