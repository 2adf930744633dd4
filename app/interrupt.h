// SIGINT and SIGTERM stop the work at hand; a second one ends the process at once.
#pragma once

#include "lodestone/base/task.h"

namespace lodestone::app {

/// From now on SIGINT, SIGTERM and SIGHUP cancel `root`. Call once. Also makes a file-size limit (SIGXFSZ) an ordinary
/// write error.
void cancel_on_signals(const Task& root);

}  // namespace lodestone::app
