// What `lod measure` prints without --json.
#pragma once

#include <string>

#include "app/output/reports.h"

namespace lodestone::app {

std::string table_of(const MeasureReport& report);

}  // namespace lodestone::app
