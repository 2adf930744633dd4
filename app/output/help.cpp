#include "app/output/help.h"

#include <fmt/format.h>

#include "app/output/console.h"
#include "app/output/text.h"
#include "app/verbs/verbs.h"

namespace lodestone::app {
namespace {

constexpr std::size_t kWidth = 100;
constexpr std::size_t kTextColumn = 24;  // where the text of options begins

// A heading and its text in two columns; the text goes below when the heading is long.
std::string two_columns(const std::string& heading, const std::string& text) {
  const std::string body = wrapped(text, kWidth, kTextColumn);
  if (heading.size() + 4 > kTextColumn) {
    return fmt::format("  {}\n{}{}\n", heading, std::string(kTextColumn, ' '), body);
  }
  return fmt::format("  {:<{}}{}\n", heading, kTextColumn - 2, body);
}

}  // namespace

const char* version() { return LODESTONE_VERSION; }

std::string option_heading(const OptionSpec& option) {
  std::string out = option.short_name.empty() ? "" : option.short_name + ", ";
  out += option.name;
  if (!option.is_switch()) out += " " + option.value;
  return out;
}

std::string option_text(const OptionSpec& option) {
  std::vector<std::string> facts;
  if (!option.unit.empty()) facts.push_back(option.unit);
  if (!option.choices.empty()) facts.push_back(fmt::format("one of {}", fmt::join(option.choices, ", ")));
  if (!option.default_value.empty()) facts.push_back("default " + option.default_value);
  return facts.empty() ? option.text : fmt::format("{} ({})", option.text, fmt::join(facts, "; "));
}

std::string usage_line(const VerbSpec& verb) {
  const bool writes = find_option(verb, "--output") != nullptr && verb.name != "convert";
  return fmt::format("lod {} {}{} [options]", verb.name, verb.inputs.usage, writes ? " -o OUTPUT" : "");
}

std::string overview_help() {
  std::string out =
      "lod makes levels of detail with measured errors.\n\nUsage: lod VERB INPUT... [-o OUTPUT] [options]\n\nVerbs:\n";
  for (const VerbSpec& verb : verbs()) {
    out += fmt::format("  {:<12}{}\n", verb.name, wrapped(verb.summary, kWidth, 14));
  }
  out += "\nTry:\n";
  for (const char* name : {"sample", "build"}) out += fmt::format("  {}\n", find_verb(name)->examples.front().command);
  out += "\nMore: lod help VERB, lod --version\n\nExit codes:\n";
  for (const Example& code : exit_codes()) out += fmt::format("  {:<6}{}\n", code.command, code.text);
  return out;
}

std::string verb_help(const VerbSpec& verb) {
  std::string out = fmt::format("{}\n\nUsage: {}\n\nExamples:\n", verb.summary, usage_line(verb));
  for (const Example& example : verb.examples) {
    out += fmt::format("  {}\n      {}\n", example.command, wrapped(example.text, kWidth, 6));
  }
  if (!verb.inputs.choices.empty()) {
    const std::string choices = fmt::format("{}: {}", verb.inputs.usage, fmt::join(verb.inputs.choices, ", "));
    out += fmt::format("\n{}\n", wrapped(choices, kWidth, 0));
  }
  if (!verb.notes.empty()) out += "\n" + wrapped(verb.notes, kWidth, 0) + "\n";
  for (const OptionGroup& group : verb.groups) {
    out += fmt::format("\n{}:\n", group.title);
    for (const OptionSpec& option : group.options) out += two_columns(option_heading(option), option_text(option));
  }
  return out;
}

Result<ExitCode> run_help(const Arguments& arguments, Console& console) {
  if (arguments.has("--man")) {
    console.result(man_page());
  } else if (arguments.inputs.empty()) {
    console.result(overview_help());
  } else {
    console.result(verb_help(*find_verb(arguments.inputs.front())));
  }
  return ExitCode::done;
}

}  // namespace lodestone::app
