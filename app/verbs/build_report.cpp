#include "app/verbs/build_report.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>
#include <utility>

#include "app/output/help.h"
#include "app/output/setting_names.h"
#include "lodestone/report/ladder_report.h"

namespace lodestone::app {

namespace {

// Defaults that another option puts out of use.
bool applies(std::string_view option, const Arguments& arguments) {
  if (option == "--pixels") return arguments.has("--distances");
  if (option != "--levels") return true;
  constexpr std::array<std::string_view, 4> kOtherTargets{"--ratio", "--triangles", "--error", "--distances"};
  return std::none_of(kOtherTargets.begin(), kOtherTargets.end(), [&](auto target) { return arguments.has(target); });
}

}  // namespace

std::vector<report::ReportOption> report_options(const Arguments& arguments) {
  constexpr std::array<std::string_view, 2> kNoSay{"--json", "--report"};
  std::vector<report::ReportOption> options;
  for (const OptionGroup& group : arguments.verb->groups) {
    if (group.title == "General") continue;
    for (const OptionSpec& option : group.options) {
      if (std::find(kNoSay.begin(), kNoSay.end(), option.name) != kNoSay.end()) continue;
      const bool given = arguments.has(option.name);
      if (!given && (option.default_value.empty() || !applies(option.name, arguments))) continue;
      std::string value = arguments.text(option.name);
      // Pages are passed on: what folders are called is nobody else's business.
      if (option.completion == Completion::file) value = std::filesystem::path(value).filename().string();
      options.push_back({option.name, std::move(value), given});
    }
  }
  return options;
}

Result<ReportPage> ReportPage::draw(const BuildJob& job, const BuildPlan& plan, const chain::LadderResult& result,
                                    const std::vector<std::string>& warnings, const Task& task) {
  Result<OutputFile> file = OutputFile::create(job.report);
  LODESTONE_TRY(file);
  Result<report::ReportData> data = report::ladder_report(result, {}, task);
  LODESTONE_TRY(data);
  data->name = job.input.filename().string();
  data->unit = unit_name(result.ladder.original.meters_per_unit);
  data->view = plan.view;
  data->options = plan.options;
  data->options.insert(data->options.begin(), {"INPUT", job.input.filename().string(), true});
  data->version = version();
  data->warnings.insert(data->warnings.end(), warnings.begin(), warnings.end());
  data->warnings = with_options(std::move(data->warnings));
  data->shortfalls = with_options(std::move(data->shortfalls));
  return ReportPage(std::move(*data), std::move(*file));
}

Result<void> ReportPage::finish(const io::WriteReport& written) {
  report::add_files(data_, written);
  file_.write(std::string_view(report::html_report(data_)));
  return file_.commit();
}

}  // namespace lodestone::app
