// build --report: a page about the ladder.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "app/options/command_line.h"
#include "app/verbs/build_plan.h"
#include "lodestone/base/file.h"
#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/chain/ladder/build_ladder.h"
#include "lodestone/io/write.h"
#include "lodestone/report/html_report.h"

namespace lodestone::app {

/// What was typed and what goes without saying, but for what has no say in the result (threads, quiet, JSON).
std::vector<report::ReportOption> report_options(const Arguments& arguments);

/// A page that waits for the levels' files: its pictures are drawn, its file is open. Without finish() nothing of it
/// stays.
class ReportPage {
 public:
  /// `warnings`: what was told about the model on top of its own. Errors: those of drawing; cannot_write.
  static Result<ReportPage> draw(const BuildJob& job, const BuildPlan& plan, const chain::LadderResult& result,
                                 const std::vector<std::string>& warnings, const Task& task);
  /// Writes it whole. Errors: cannot_write.
  Result<void> finish(const io::WriteReport& written);

 private:
  ReportPage(report::ReportData data, OutputFile file) : data_(std::move(data)), file_(std::move(file)) {}
  report::ReportData data_;
  OutputFile file_;
};

}  // namespace lodestone::app
