// The progress bar: one line on standard error, on a terminal only.
#pragma once

#include <chrono>
#include <mutex>
#include <string>

#include "lodestone/base/task.h"

namespace lodestone::app {

/// Draws at most ten times a second: what is being done, a bar, the share done, the time left.
class Progress {
 public:
  explicit Progress(bool shown);
  ~Progress();

  /// To be given to Task::root; must not outlive this.
  ProgressCallback callback();
  /// What stands before the label, such as the file at work in a batch.
  void set_title(std::string title);
  /// Takes the bar off the screen, so that something else can be printed.
  void clear();

 private:
  void update(double done, const std::string& label);

  using Clock = std::chrono::steady_clock;
  bool shown_;
  std::mutex mutex_;
  Clock::time_point start_, last_drawn_;
  std::string title_;
  bool on_screen_ = false;
};

}  // namespace lodestone::app
