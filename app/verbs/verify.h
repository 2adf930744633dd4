// build --verify: levels are read back from what was written and measured again.
#pragma once

#include "app/output/reports.h"
#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/measure/distance.h"

namespace lodestone::app {

/// Reads every level that `report` names back from its file, measures it against level 0 as it was written, and holds
/// its triangles and its error, as a share of the diagonal, to what was told. Errors: bad_format (the file is not what
/// was told), those of reading, cancelled.
Result<VerifyReport> verify_levels(const BuildReport& report, const measure::DistanceOptions& distance,
                                   const Task& task);

}  // namespace lodestone::app
