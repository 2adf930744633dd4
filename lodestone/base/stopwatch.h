// Wall time of phases, for reports; it never enters a result.
#pragma once

#include <chrono>

namespace lodestone {

class Stopwatch {
 public:
  /// Seconds since the last lap, or since the beginning.
  double lap() {
    const Clock::time_point now = Clock::now();
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    return seconds;
  }
  /// Seconds since the beginning.
  double total() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now(), last_ = start_;
};

}  // namespace lodestone
