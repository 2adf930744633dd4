// SIGINT, SIGTERM and SIGHUP stop the work at hand; only the third ends the process at once.
#pragma once

#include "lodestone/base/task.h"

namespace lodestone::app {

/// From now on the first of these signals cancels `root`, the second tells on standard error what a third one would
/// leave behind, and the third ends the process. Call once. Also makes a file-size limit (SIGXFSZ) an ordinary write
/// error.
void cancel_on_signals(const Task& root);

}  // namespace lodestone::app
