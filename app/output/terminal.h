// What standard error can show.
#pragma once

namespace lodestone::app {

enum class Terminal {
  none,   ///< no terminal, or one that can't go back in a line (TERM=dumb): no bar
  plain,  ///< no escape codes wanted (NO_COLOR): lines are overwritten by spaces
  full,
};

/// By what standard error is and by TERM and NO_COLOR.
Terminal error_terminal();

}  // namespace lodestone::app
