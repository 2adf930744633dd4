// render --sheet: all levels of a ladder in one picture.
#pragma once

#include "app/exit_code.h"
#include "app/options/command_line.h"
#include "app/options/spec.h"
#include "app/output/console.h"
#include "lodestone/base/result.h"

namespace lodestone::app {

OptionGroup sheet_group();  ///< --sheet, --height, --pixels

/// The levels of a glTF file, or the files given: the first is the original.
Result<ExitCode> run_sheet(const Arguments& arguments, Console& console);

}  // namespace lodestone::app
