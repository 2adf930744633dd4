#include <fmt/format.h>

#include "app/options/command_line.h"
#include "app/output/console.h"
#include "app/output/help.h"
#include "app/verbs/verbs.h"

namespace lodestone::app {
namespace {

std::vector<std::string> option_names(const VerbSpec& verb) {
  std::vector<std::string> names;
  for (const OptionGroup& group : verb.groups) {
    for (const OptionSpec& option : group.options) {
      names.push_back(option.name);
      if (!option.short_name.empty()) names.push_back(option.short_name);
    }
  }
  return names;
}

std::vector<std::string> verb_names() {
  std::vector<std::string> names;
  for (const VerbSpec& verb : verbs()) names.push_back(verb.name);
  return names;
}

std::string names_pattern(const OptionSpec& option) {
  return option.short_name.empty() ? option.name : option.short_name + "|" + option.name;
}

// --- bash -------------------------------------------------------------------------------------------------------

std::string bash_words(const std::vector<std::string>& words) {
  return fmt::format("COMPREPLY=($(compgen -W '{}' -- \"$current\"))", fmt::join(words, " "));
}

std::string bash_verb(const VerbSpec& verb) {
  std::string out = fmt::format("    {})\n      case \"$before\" in\n", verb.name);
  for (const OptionGroup& group : verb.groups) {
    for (const OptionSpec& option : group.options) {
      if (option.is_switch()) continue;
      const std::string action = !option.choices.empty()                 ? bash_words(option.choices)
                                 : option.completion == Completion::file ? "COMPREPLY=($(compgen -f -- \"$current\"))"
                                                                         : "COMPREPLY=()";
      out += fmt::format("        {}) {}; return ;;\n", names_pattern(option), action);
    }
  }
  const std::string inputs =
      verb.inputs.choices.empty() ? "COMPREPLY=($(compgen -f -- \"$current\"))" : bash_words(verb.inputs.choices);
  out += fmt::format(
      "      esac\n      if [[ \"$current\" == -* ]]; then\n        {}\n      else\n        {}\n      fi ;;\n",
      bash_words(option_names(verb)), inputs);
  return out;
}

std::string bash_script() {
  std::string out =
      "# bash completion for lod; made by 'lod completion bash'\n"
      "_lod() {\n"
      "  local IFS=$'\\n \\t' current=\"${COMP_WORDS[COMP_CWORD]}\" before=\"${COMP_WORDS[COMP_CWORD-1]}\"\n"
      "  compopt -o filenames 2>/dev/null\n"
      "  if ((COMP_CWORD == 1)); then\n";
  std::vector<std::string> first = verb_names();
  first.insert(first.end(), {"--help", "--version"});
  out += fmt::format("    {}\n    return\n  fi\n  case \"${{COMP_WORDS[1]}}\" in\n", bash_words(first));
  for (const VerbSpec& verb : verbs()) out += bash_verb(verb);
  return out + "  esac\n}\ncomplete -F _lod lod\n";
}

// --- zsh --------------------------------------------------------------------------------------------------------

// For single quotes and for _arguments, where brackets and colons mean something.
std::string zsh_text(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '\'') {
      out += "'\\''";
    } else if (c == '[' || c == ']' || c == ':' || c == '\\') {
      out += '\\';
      out += c;
    } else {
      out += c;
    }
  }
  return out;
}

std::string zsh_option(const OptionSpec& option) {
  std::string value;
  if (!option.is_switch()) {
    value = fmt::format(":{}:", zsh_text(option.value));
    if (!option.choices.empty()) value += fmt::format("({})", fmt::join(option.choices, " "));
    if (option.completion == Completion::file) value += "_files";
  }
  const std::string text = zsh_text(option_text(option));
  if (option.short_name.empty()) return fmt::format("        '{}[{}]{}' \\\n", option.name, text, value);
  return fmt::format("        '({0} {1})'{{{0},{1}}}'[{2}]{3}' \\\n", option.short_name, option.name, text, value);
}

std::string zsh_script() {
  std::string out =
      "#compdef lod\n# zsh completion for lod; made by 'lod completion zsh'\n_lod() {\n  local -a verbs\n  verbs=(\n";
  for (const VerbSpec& verb : verbs()) out += fmt::format("    '{}:{}'\n", verb.name, zsh_text(verb.summary));
  out +=
      "  )\n  if ((CURRENT == 2)); then\n    _describe 'verb' verbs\n    return\n  fi\n"
      "  local verb=$words[2]\n  shift words\n  ((CURRENT--))\n  case $verb in\n";
  for (const VerbSpec& verb : verbs()) {
    out += fmt::format("    {})\n      _arguments \\\n", verb.name);
    for (const OptionGroup& group : verb.groups) {
      for (const OptionSpec& option : group.options) out += zsh_option(option);
    }
    const std::string inputs =
        verb.inputs.choices.empty() ? "_files" : fmt::format("({})", fmt::join(verb.inputs.choices, " "));
    out += fmt::format("        '*:{}:{}' ;;\n", zsh_text(verb.inputs.usage), inputs);
  }
  return out + "  esac\n}\nif [ \"$funcstack[1]\" = \"_lod\" ]; then\n  _lod \"$@\"\nelse\n  compdef _lod lod\nfi\n";
}

// --- fish -------------------------------------------------------------------------------------------------------

std::string fish_text(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '\'' || c == '\\') out += '\\';
    out += c;
  }
  return out;
}

std::string fish_script() {
  std::string out = "# fish completion for lod; made by 'lod completion fish'\n";
  for (const VerbSpec& verb : verbs()) {
    out +=
        fmt::format("complete -c lod -n __fish_use_subcommand -f -a {} -d '{}'\n", verb.name, fish_text(verb.summary));
  }
  out += "complete -c lod -n __fish_use_subcommand -l version -d 'print the version'\n";
  for (const VerbSpec& verb : verbs()) {
    const std::string when = fmt::format("complete -c lod -n '__fish_seen_subcommand_from {}'", verb.name);
    if (!verb.inputs.choices.empty()) out += fmt::format("{} -f -a '{}'\n", when, fmt::join(verb.inputs.choices, " "));
    for (const OptionGroup& group : verb.groups) {
      for (const OptionSpec& option : group.options) {
        out += fmt::format("{} -l {}", when, option.name.substr(2));
        if (!option.short_name.empty()) out += " -s " + option.short_name.substr(1);
        if (!option.is_switch()) out += option.completion == Completion::file ? " -r -F" : " -x";
        if (!option.choices.empty()) out += fmt::format(" -a '{}'", fmt::join(option.choices, " "));
        out += fmt::format(" -d '{}'\n", fish_text(option_text(option)));
      }
    }
  }
  return out;
}

}  // namespace

std::string completion_script(const std::string& shell) {
  return shell == "bash" ? bash_script() : shell == "zsh" ? zsh_script() : fish_script();
}

Result<ExitCode> run_completion(const Arguments& arguments, Console& console) {
  console.result(completion_script(arguments.inputs.front()));
  return ExitCode::done;
}

}  // namespace lodestone::app
