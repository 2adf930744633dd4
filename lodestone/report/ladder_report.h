// From a ladder that was built and written to the data of its report.
#pragma once

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/chain/ladder/build_ladder.h"
#include "lodestone/io/write.h"
#include "lodestone/report/html_report.h"

namespace lodestone::report {

/// Draws all levels and counts their shapes; fills in all but `name`, `unit`, `view`, `options`, `version` and what
/// add_files() knows: this is the long part, to be done before anything is written. The
/// original's textures must be decoded before the ladder is built (io::decode_base_colors()). Errors: those of
/// draw_levels().
Result<ReportData> ladder_report(const chain::LadderResult& result, const PictureOptions& pictures = {},
                                 Task task = {});

/// The levels' files and bytes, and what a format could not hold.
void add_files(ReportData& data, const io::WriteReport& written);

}  // namespace lodestone::report
