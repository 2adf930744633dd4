// LODESTONE_CHECK: invariants that stay in release. For what only a programmer can cause; input is answered by Result.
#pragma once

namespace lodestone {

/// Prints file, line and condition to standard error and aborts.
[[noreturn]] void check_failed(const char* file, int line, const char* condition, const char* message) noexcept;

}  // namespace lodestone

/// Guards an invariant or a size: `LODESTONE_CHECK(a.size() == b.size(), "one weight a vertex");`
#define LODESTONE_CHECK(condition, message)                               \
  do {                                                                    \
    if (!(condition)) [[unlikely]]                                        \
      ::lodestone::check_failed(__FILE__, __LINE__, #condition, message); \
  } while (false)
