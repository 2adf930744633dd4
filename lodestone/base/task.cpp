#include "lodestone/base/task.h"

#include <algorithm>
#include <atomic>
#include <mutex>

namespace lodestone {

struct Task::Root {
  ProgressCallback callback;
  int threads = 0;
  std::atomic<bool> cancelled{false};
  std::mutex mutex;
  double done = 0;  // guarded by mutex

  void add(double share, const std::string& label) {
    if (!callback || share <= 0 || cancelled.load(std::memory_order_relaxed)) return;  // what is dropped is not done
    const std::lock_guard lock(mutex);
    done = std::min(1.0, done + share);
    callback(done, label);
  }

  // What begins, before any of it is done.
  void tell(const std::string& label) {
    if (!callback || label.empty()) return;
    const std::lock_guard lock(mutex);
    callback(done, label);
  }
};

struct Task::Span {
  std::shared_ptr<Root> root;
  double size;  // share of the root
  std::string label;
  std::atomic<double> used{0};  // share of this span already claimed or handed out

  // Takes up to `share` of what is left and returns what it got.
  double take(double share) {
    double before = used.load(std::memory_order_relaxed);
    double after = 0;
    do {
      after = std::min(1.0, before + std::max(0.0, share));
    } while (!used.compare_exchange_weak(before, after, std::memory_order_relaxed));
    return after - before;
  }

  ~Span() { root->add(take(1.0) * size, label); }
};

Task Task::root(ProgressCallback callback, int threads) {
  Task task;
  task.root_ = std::make_shared<Root>();
  task.root_->callback = std::move(callback);
  task.root_->threads = threads;
  task.span_ = std::make_shared<Span>();
  task.span_->root = task.root_;
  task.span_->size = 1.0;
  return task;
}

Task Task::part(double share, std::string label) const {
  if (!root_) return {};
  Task task;
  task.root_ = root_;
  task.span_ = std::make_shared<Span>();
  task.span_->root = root_;
  task.span_->size = span_->take(share) * span_->size;
  root_->tell(label);
  task.span_->label = label.empty() ? span_->label : std::move(label);
  return task;
}

void Task::advance(double share) const {
  if (root_) root_->add(span_->take(share) * span_->size, span_->label);
}

bool Task::cancelled() const { return root_ && root_->cancelled.load(std::memory_order_relaxed); }

void Task::cancel() const {
  if (root_) root_->cancelled.store(true, std::memory_order_relaxed);
}

int Task::threads() const { return root_ ? root_->threads : 0; }

}  // namespace lodestone
