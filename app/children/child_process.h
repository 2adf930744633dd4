// Work that may crash or hang, in a process of its own with limits on memory and time.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "app/children/child_report.h"
#include "lodestone/base/result.h"
#include "lodestone/base/task.h"

namespace lodestone::app {

struct ChildLimits {
  std::uint64_t memory_bytes;  ///< of addresses; also of any file that it writes
  std::uint64_t cpu_seconds;
  std::chrono::seconds wall;
};
/// A file of a few kilobytes may not cost more than 2 GiB and 30 s; larger ones get more in proportion.
ChildLimits limits_for(std::uint64_t file_bytes);

struct ChildOutcome {
  ChildReport report;
  int status = 0;  ///< as waitpid tells it
  enum class End { exited, timed_out, cancelled } end = End::exited;
};

/// Runs a program with these words until it ends, a limit is met, or the task is cancelled. Its standard input and
/// outputs lead nowhere. Errors: cannot_read (no process could be started).
Result<ChildOutcome> run_child(const std::filesystem::path& program, std::vector<std::string> words,
                               const ChildLimits& limits, const Task& task);

/// Why a child that did not finish its report ended, in plain words.
std::string ending_of(const ChildOutcome& outcome, const ChildLimits& limits);

/// A private folder that goes with all that is in it.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  /// Empty when none could be made.
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// How the names of temporary folders begin: "/tmp/lod-<process id>-".
std::string temporary_folder_pattern();

}  // namespace lodestone::app
