// What the command tells the shell.
#pragma once

#include "lodestone/base/result.h"

namespace lodestone::app {

enum class ExitCode {
  done = 0,
  failed = 1,        ///< input, output or memory
  usage = 2,         ///< the command line makes no sense
  fell_short = 3,    ///< the result is written, but the asked target was not reached
  interrupted = 130  ///< SIGINT or SIGTERM
};

inline ExitCode exit_code_of(const Error& error) {
  if (error.code == ErrorCode::bad_argument) return ExitCode::usage;
  if (error.code == ErrorCode::cancelled) return ExitCode::interrupted;
  return ExitCode::failed;
}

}  // namespace lodestone::app
