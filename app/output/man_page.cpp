#include <fmt/format.h>

#include "app/output/help.h"

namespace lodestone::app {
namespace {

// Text that roff leaves alone: backslashes and hyphens escaped, no control line by accident.
std::string roff(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\') {
      out += "\\e";
    } else if (c == '-') {
      out += "\\-";
    } else {
      out += c;
    }
  }
  if (!out.empty() && (out[0] == '.' || out[0] == '\'')) out.insert(0, "\\&");
  return out;
}

std::string verb_section(const VerbSpec& verb) {
  std::string out =
      fmt::format(".SS {}\n{}\n.PP\n.B {}\n", roff(verb.name), roff(verb.summary), roff(usage_line(verb)));
  if (!verb.inputs.choices.empty()) {
    out += fmt::format(".PP\n{}: {}\n", roff(verb.inputs.usage),
                       roff(fmt::format("{}", fmt::join(verb.inputs.choices, ", "))));
  }
  if (!verb.notes.empty()) out += fmt::format(".PP\n{}\n", roff(verb.notes));
  for (const OptionGroup& group : verb.groups) {
    if (group.title == "General") continue;  // told once for all verbs
    out += fmt::format(".PP\n{}:\n", roff(group.title));
    for (const OptionSpec& option : group.options) {
      out += fmt::format(".TP\n.B {}\n{}\n", roff(option_heading(option)), roff(option_text(option)));
    }
  }
  out += ".PP\nExamples:\n";
  for (const Example& example : verb.examples) {
    out += fmt::format(".TP\n.B {}\n{}\n", roff(example.command), roff(example.text));
  }
  return out;
}

}  // namespace

std::string man_page() {
  std::string out = fmt::format(".TH LOD 1 \"\" \"Lodestone {}\" \"User Commands\"\n", version());
  out += ".SH NAME\nlod \\- levels of detail with measured errors\n";
  out += ".SH SYNOPSIS\n";
  for (const VerbSpec& verb : verbs()) out += fmt::format(".B {}\n.br\n", roff(usage_line(verb)));
  out +=
      ".SH DESCRIPTION\n"
      "A model goes in; a ladder of levels comes out, each with an error that was measured against the original. "
      "Results go to standard output, everything else to standard error. Outputs appear whole or not at all.\n";
  out += ".SH OPTIONS OF EVERY VERB\n";
  const OptionGroup& general = verbs().front().groups.back();
  for (const OptionSpec& option : general.options) {
    out += fmt::format(".TP\n.B {}\n{}\n", roff(option_heading(option)), roff(option_text(option)));
  }
  out += ".SH VERBS\n";
  for (const VerbSpec& verb : verbs()) out += verb_section(verb);
  out += ".SH EXIT STATUS\n";
  for (const Example& code : exit_codes()) out += fmt::format(".TP\n.B {}\n{}\n", code.command, roff(code.text));
  return out;
}

}  // namespace lodestone::app
