// render --sheet: all levels of a ladder in one picture.
#pragma once

#include "app/command_line.h"
#include "app/console.h"
#include "app/exit_code.h"
#include "app/spec.h"
#include "lodestone/base/result.h"

namespace lodestone::app {

OptionGroup sheet_group();  ///< --sheet, --height, --pixels

/// The levels of a glTF file, or the files given: the first is the original.
Result<ExitCode> run_sheet(const Arguments& arguments, Console& console);

}  // namespace lodestone::app
