#include "app/output/terminal.h"

#include <unistd.h>

#include <cstdlib>
#include <string_view>

namespace lodestone::app {

Terminal error_terminal() {
  if (::isatty(STDERR_FILENO) != 1) return Terminal::none;
  const char* name = std::getenv("TERM");
  if (name == nullptr || std::string_view(name) == "dumb") return Terminal::none;
  const char* plain = std::getenv("NO_COLOR");
  return plain != nullptr && *plain != 0 ? Terminal::plain : Terminal::full;
}

}  // namespace lodestone::app
