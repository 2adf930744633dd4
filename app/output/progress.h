// The progress bar: one line on standard error, on a terminal only.
#pragma once

#include <chrono>
#include <cstddef>
#include <mutex>
#include <string>

#include "app/output/terminal.h"
#include "app/output/time_left.h"
#include "lodestone/base/task.h"

namespace lodestone::app {

/// Draws at most ten times a second: what is being done, a bar, the share done, the time left. Drawn or not, it knows
/// what is being done.
class Progress {
 public:
  explicit Progress(Terminal terminal);
  ~Progress();

  /// To be given to Task::root; must not outlive this.
  ProgressCallback callback();
  /// What stands before the label, such as the file at work in a batch.
  void set_title(std::string title);
  /// Takes the bar off the screen, so that something else can be printed.
  void clear();
  /// "simplifying, 40 % done"; empty before anything was told.
  std::string at_work() const;

 private:
  void update(double done, const std::string& label);
  void erase();

  using Clock = std::chrono::steady_clock;
  Terminal terminal_;
  mutable std::mutex mutex_;
  Clock::time_point start_, last_drawn_;
  TimeLeft time_left_;
  std::string title_, label_;
  double done_ = 0;
  std::size_t on_screen_ = 0;  // columns that the bar takes
};

}  // namespace lodestone::app
