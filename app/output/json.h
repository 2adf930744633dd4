// Reports as JSON. Field names are promises to scripts: they may be added to, never changed.
#pragma once

#include <string>
#include <vector>

#include "app/output/reports.h"

namespace lodestone::app {

/// Each is one object with a newline at the end. Bytes of names that are not UTF-8 become U+FFFD.
std::string to_json(const BuildReport& report);
std::string to_json(const std::vector<BuildReport>& runs);  ///< {"runs": [...]}
std::string to_json(const SimplifyReport& report);
std::string to_json(const MeasureReport& report);
std::string to_json(const InfoReport& report);
std::string to_json(const RenderReport& report);
std::string to_json(const SheetReport& report);
std::string to_json(const VoxelReport& report);
std::string to_json(const ConvertReport& report);
std::string to_json(const SampleReport& report);

}  // namespace lodestone::app
