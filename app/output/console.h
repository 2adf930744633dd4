// What the command says: results to standard output, everything else to standard error.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "app/output/progress.h"
#include "lodestone/base/result.h"
#include "lodestone/base/task.h"

namespace lodestone::app {

class Console {
 public:
  enum class Talk { quiet, normal, verbose };
  Console(Talk talk, int threads);

  /// The root of all work of this run; reports to the progress bar.
  const Task& task() const { return task_; }
  /// The file at work, for the progress bar.
  void set_title(std::string title) { progress_.set_title(std::move(title)); }

  void note(std::string_view text) const;       ///< unless --quiet
  void detail(std::string_view text) const;     ///< with --verbose
  void error(const Error& error) const;         ///< always
  Error stopped() const;                        ///< what an interrupted run says: what it was doing
  void shortfall(std::string_view text) const;  ///< always: why a target was not reached
  /// To standard output. Errors are found by finish().
  void result(std::string_view text) const;
  /// A result as a table or line for people, to standard output; not with --quiet.
  void table(std::string_view text) const;
  /// Remembers a result file that stands under its name, for finish().
  void wrote(const std::string& file);
  /// Flushes standard output. Errors: cannot_write; it says which files were written all the same.
  Result<void> finish() const;

 private:
  void say(std::string_view line) const;
  Talk talk_;
  mutable Progress progress_;
  Task task_;
  std::vector<std::string> written_;
};

}  // namespace lodestone::app
