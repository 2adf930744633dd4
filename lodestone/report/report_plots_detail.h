// The report's curves.
#pragma once

#include <string>

#include "lodestone/report/html_report.h"

namespace lodestone::report::detail {

/// Error and size over triangles, and pixels over distance; a sentence instead where there are no levels.
std::string plots(const ReportData& data);

}  // namespace lodestone::report::detail
