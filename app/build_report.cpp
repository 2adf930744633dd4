#include "app/build_report.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "app/help.h"
#include "lodestone/base/file.h"
#include "lodestone/report/ladder_report.h"

namespace lodestone::app {

std::vector<report::ReportOption> report_options(const Arguments& arguments) {
  constexpr std::array<std::string_view, 2> kNoSay{"--json", "--report"};
  std::vector<report::ReportOption> options;
  for (const std::string& input : arguments.inputs) options.push_back({"INPUT", input, true});
  for (const OptionGroup& group : arguments.verb->groups) {
    if (group.title == "General") continue;
    for (const OptionSpec& option : group.options) {
      if (std::find(kNoSay.begin(), kNoSay.end(), option.name) != kNoSay.end()) continue;
      const bool given = arguments.has(option.name);
      if (!given && option.default_value.empty()) continue;
      options.push_back({option.name, arguments.text(option.name), given});
    }
  }
  return options;
}

Result<void> write_report(const BuildJob& job, const BuildPlan& plan, const chain::LadderResult& result,
                          const io::WriteReport& written, const std::vector<std::string>& warnings, Console& console,
                          const Task& task) {
  Result<report::ReportData> data = report::ladder_report(result, written, {}, task);
  if (!data) return fail(data.error());
  data->name = job.input.filename().string();
  data->unit = unit_name(result.ladder.original.meters_per_unit);
  data->view = plan.view;
  data->options = plan.options;
  data->version = version();
  data->warnings.insert(data->warnings.end(), warnings.begin(), warnings.end());
  Result<OutputFile> file = OutputFile::create(job.report);
  if (!file) return fail(file.error());
  file->write(std::string_view(report::html_report(*data)));
  if (Result<void> done = file->commit(); !done) return done;
  console.wrote(job.report.string());
  return {};
}

}  // namespace lodestone::app
