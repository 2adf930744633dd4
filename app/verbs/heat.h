// measure --heat: a surface coloured by its distance to another, as a file.
#pragma once

#include <string>
#include <vector>

#include "app/output/console.h"
#include "app/output/reports.h"
#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/model.h"

namespace lodestone::app {

/// Before any work: a format that keeps numbers a vertex, and a place that can be written. Errors: bad_argument,
/// unsupported, cannot_write.
Result<void> check_heat_output(const std::string& output, const std::vector<std::string>& inputs);

/// Writes A coloured by its distance to B. Errors: those of heat_map and of writing.
Result<HeatReport> write_heat(const Model& a, const Model& b, const std::string& output, Console& console,
                              const Task& task);

}  // namespace lodestone::app
