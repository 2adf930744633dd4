// The verbs: one function and one file each. Each prints its result and returns the exit code, or an Error for main to
// tell.
#pragma once

#include "app/exit_code.h"
#include "app/options/command_line.h"
#include "app/output/console.h"

namespace lodestone::app {

Result<ExitCode> run_build(const Arguments& arguments, Console& console);
Result<ExitCode> run_simplify(const Arguments& arguments, Console& console);
Result<ExitCode> run_measure(const Arguments& arguments, Console& console);
Result<ExitCode> run_info(const Arguments& arguments, Console& console);
Result<ExitCode> run_render(const Arguments& arguments, Console& console);
Result<ExitCode> run_convert(const Arguments& arguments, Console& console);
Result<ExitCode> run_remesh(const Arguments& arguments, Console& console);
Result<ExitCode> run_boolean(const Arguments& arguments, Console& console);
Result<ExitCode> run_voxelize(const Arguments& arguments, Console& console);
Result<ExitCode> run_sample(const Arguments& arguments, Console& console);
Result<ExitCode> run_help(const Arguments& arguments, Console& console);
Result<ExitCode> run_completion(const Arguments& arguments, Console& console);

}  // namespace lodestone::app
