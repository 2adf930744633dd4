// Texts made from the definitions in spec.h: help, manual page, completion scripts.
#pragma once

#include <string>

#include "app/options/spec.h"

namespace lodestone::app {

/// What `lod help` prints: the verbs, a sentence each.
std::string overview_help();
/// What `lod help VERB` prints: a sentence, examples, options by group with units and defaults.
std::string verb_help(const VerbSpec& verb);
/// The manual page, roff with man macros.
std::string man_page();
/// The completion script of "bash", "zsh" or "fish".
std::string completion_script(const std::string& shell);

/// "-o, --output OUTPUT"
std::string option_heading(const OptionSpec& option);
/// "what it does (unit; default 5; one of a, b)"
std::string option_text(const OptionSpec& option);
/// "lod build INPUT... -o OUTPUT [options]"
std::string usage_line(const VerbSpec& verb);

/// "0.1.0"
const char* version();

}  // namespace lodestone::app
