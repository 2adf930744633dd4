// The command `lod`: finds the verb, parses its options, runs it, and turns errors into one line and an exit code.
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <limits>
#include <new>
#include <string>
#include <vector>

#include "app/children/foreign.h"
#include "app/interrupt.h"
#include "app/options/command_line.h"
#include "app/options/suggest.h"
#include "app/output/console.h"
#include "app/output/help.h"
#include "app/output/text.h"
#include "lodestone/base/parallel.h"

namespace lodestone::app {
namespace {

int code(ExitCode exit_code) { return static_cast<int>(exit_code); }

int tell(const Error& error) {
  fmt::print(stderr, "{}\n", error_text(error));
  return code(exit_code_of(error));
}

// For what is answered without a verb: --help and --version.
int print(const std::string& text) {
  std::fwrite(text.data(), 1, text.size(), stdout);
  if (std::fflush(stdout) == 0) return code(ExitCode::done);
  return tell(Error{ErrorCode::cannot_write, "the result could not be written", "standard output", {}});
}

Error unknown_verb(const std::string& word) {
  if (word[0] == '-') {
    return Error{ErrorCode::bad_argument,
                 fmt::format("'{}' stands before a verb", word),
                 {},
                 "options go after the verb; see 'lod help'"};
  }
  std::vector<std::string> names;
  for (const VerbSpec& verb : verbs()) names.push_back(verb.name);
  return Error{
      ErrorCode::bad_argument, fmt::format("no verb '{}'{}", word, did_you_mean(word, names)), {}, "see 'lod help'"};
}

int run_verb(const VerbSpec& verb, const Arguments& arguments) {
  constexpr std::uint64_t kMostThreads = 1024;
  const Result<std::uint64_t> threads = arguments.count("--threads", 0, kMostThreads);
  if (!threads) return tell(threads.error());
  const int thread_count = static_cast<int>(*threads);
  const ThreadLimit limit(thread_count);
  const Console::Talk talk = arguments.has("--quiet")     ? Console::Talk::quiet
                             : arguments.has("--verbose") ? Console::Talk::verbose
                                                          : Console::Talk::normal;
  Console console(talk, thread_count);
  cancel_on_signals(console.task());
  const Result<ExitCode> outcome = verb.run(arguments, console);
  if (!outcome) {
    console.error(outcome.error().code == ErrorCode::cancelled ? console.stopped() : outcome.error());
    return code(exit_code_of(outcome.error()));
  }
  if (const Result<void> finished = console.finish(); !finished) return tell(finished.error());
  return code(*outcome);
}

int run(const std::vector<std::string>& words) {
  if (words.empty()) {
    fmt::print(stderr, "{}", overview_help());
    return code(ExitCode::usage);
  }
  const std::string& first = words.front();
  if (first == kForeignVerb) return foreign_main({words.begin() + 1, words.end()});
  if (first == "--help" || first == "-h") return print(overview_help());
  if (first == "--version" || first == "-V") return print(fmt::format("lod {}\n", version()));
  const VerbSpec* verb = find_verb(first);
  if (verb == nullptr) return tell(unknown_verb(first.empty() ? "''" : first));
  const Result<Arguments> arguments = parse_arguments(*verb, {words.begin() + 1, words.end()});
  if (!arguments) return tell(arguments.error());
  if (arguments->has("--help")) return print(verb_help(*verb));
  return run_verb(*verb, *arguments);
}

}  // namespace
}  // namespace lodestone::app

int main(int argc, char** argv) {
  using lodestone::Error;
  using lodestone::ErrorCode;
  try {
    return lodestone::app::run({argv + (argc > 0 ? 1 : 0), argv + argc});
  } catch (const std::bad_alloc&) {
    std::fputs("lod: out of memory; use a smaller input or a machine with more\n", stderr);
  } catch (const std::exception& error) {
    lodestone::app::tell(
        Error{ErrorCode::unsupported, error.what(), "internal error", "please report it with the command line"});
  }
  return static_cast<int>(lodestone::app::ExitCode::failed);
}
