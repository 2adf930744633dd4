// build --report: a page about the ladder.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/build_plan.h"
#include "app/command_line.h"
#include "app/console.h"
#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/chain/build_ladder.h"
#include "lodestone/io/write.h"
#include "lodestone/report/html_report.h"

namespace lodestone::app {

/// What was typed and what goes without saying, but for what has no say in the result (threads, quiet, JSON).
std::vector<report::ReportOption> report_options(const Arguments& arguments);

/// Draws the levels and writes job.report whole or not at all. `warnings`: what was told about the model on top of its
/// own. Errors: those of drawing; cannot_write.
Result<void> write_report(const BuildJob& job, const BuildPlan& plan, const chain::LadderResult& result,
                          const io::WriteReport& written, const std::vector<std::string>& warnings, Console& console,
                          const Task& task);

}  // namespace lodestone::app
