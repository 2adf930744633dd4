#include "lodestone/base/check.h"

#include <cstdio>
#include <cstdlib>

namespace lodestone {

void check_failed(const char* file, int line, const char* condition, const char* message) noexcept {
  std::fprintf(stderr, "lodestone: internal error at %s:%d: %s (%s)\n", file, line, message, condition);
  std::abort();
}

}  // namespace lodestone
