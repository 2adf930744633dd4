// Task: progress that composes, cancellation and a thread count, in one cheap handle by value.
#pragma once

#include <functional>
#include <memory>
#include <string>

namespace lodestone {

/// Called with the share done so far (0 to 1, never falling) and the label of the part at work. May be called from any
/// thread, one call at a time.
using ProgressCallback = std::function<void(double done, const std::string& label)>;

/// A handle to a span of work. The default Task reports to nobody, is never cancelled and uses all threads.
///
///     Result<Mesh> mesh = read(path, task.part(0.2, "reading"));   // 20 % of whatever this task was given
///     for (...) { if (task.cancelled()) return cancelled_error("simplify"); ... task.advance(0.01); }
///
/// What a part does not claim with advance() counts as done when its last copy is gone, so shares always add up.
class Task {
 public:
  Task() = default;

  /// A root task. `threads` 0 means all that the process may use.
  static Task root(ProgressCallback callback, int threads = 0);

  /// A share (0 to 1) of this task's span, for a callee. A label is reported at once; an empty one keeps this task's.
  Task part(double share, std::string label = {}) const;

  /// Claims a share (0 to 1) of this task's span as done. Any thread.
  void advance(double share) const;

  /// True once cancel() was called on any handle of the same root. Cheap enough for every block of a loop.
  bool cancelled() const;

  /// Asks all work under the same root to stop. Async-signal-safe.
  void cancel() const;

  /// How many threads loops under this task may use; 0 = all.
  int threads() const;

 private:
  struct Root;
  struct Span;
  std::shared_ptr<Root> root_;
  std::shared_ptr<Span> span_;
};

}  // namespace lodestone
