// Parallel loops whose results do not depend on the thread count: chunks of fixed size, joined in chunk order.
// The only door to threads in the library (oneTBB behind it, or std::thread for ThreadSanitizer).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "lodestone/base/task.h"

namespace lodestone {

/// While it lives, at most `threads` threads work in the whole process. For main functions only (the one allowed
/// global); 0 = as many as the hardware has. Without it a Task's threads() above the hardware's count has no effect.
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  struct Control;
  std::unique_ptr<Control> control_;
};

namespace parallel_detail {
using ChunkFunction = void (*)(void* context, std::size_t chunk);
/// Runs function(context, 0 .. chunks-1), each once, in any order, on at most task.threads() threads.
void run_chunks(std::size_t chunks, ChunkFunction function, void* context, const Task& task);
}  // namespace parallel_detail

/// Calls body(begin, end, chunk) for [0, n) cut into chunks of `chunk_size`; the cut depends on n and chunk_size only.
/// A chunk that has not begun when the task is cancelled is left out: check task.cancelled() before using the results.
template <class Body>
void parallel_for(std::size_t n, std::size_t chunk_size, const Task& task, Body&& body) {
  const std::size_t chunks = (n + chunk_size - 1) / chunk_size;
  struct Context {
    std::size_t n, chunk_size;
    Body* body;
    const Task* task;
  } context{n, chunk_size, &body, &task};
  parallel_detail::run_chunks(
      chunks,
      [](void* raw, std::size_t chunk) {
        const Context& c = *static_cast<Context*>(raw);
        if (c.task->cancelled()) return;
        const std::size_t begin = chunk * c.chunk_size;
        (*c.body)(begin, std::min(c.n, begin + c.chunk_size), chunk);
      },
      &context, task);
}

/// map(begin, end) -> T for each chunk, then joined left to right with join(T, T) -> T. T must not be bool.
template <class T, class Map, class Join>
T parallel_reduce(std::size_t n, std::size_t chunk_size, const Task& task, T zero, Map&& map, Join&& join) {
  std::vector<T> partial((n + chunk_size - 1) / chunk_size, zero);
  parallel_for(n, chunk_size, task,
               [&](std::size_t begin, std::size_t end, std::size_t chunk) { partial[chunk] = map(begin, end); });
  T sum = std::move(zero);
  for (T& p : partial) sum = join(std::move(sum), std::move(p));
  return sum;
}

/// Replaces values[i] by the sum of all before it and returns the total. O(n). Runs to its end even when the task is
/// cancelled, so the offsets can always be trusted.
std::uint64_t exclusive_scan(std::vector<std::uint32_t>& values, const Task& task = {});

/// Stable sort by `less`, the same result for any thread count (chunks sorted apart, then merged pairwise). O(n log n).
template <class T, class Less>
void parallel_sort(std::vector<T>& values, const Task& task, Less less) {
  constexpr std::size_t kChunk = std::size_t{1} << 16;
  const std::size_t n = values.size();
  parallel_for(n, kChunk, task, [&](std::size_t begin, std::size_t end, std::size_t) {
    std::stable_sort(values.begin() + static_cast<std::ptrdiff_t>(begin),
                     values.begin() + static_cast<std::ptrdiff_t>(end), less);
  });
  if (n <= kChunk) return;
  std::vector<T> other(n);
  for (std::size_t width = kChunk; width < n; width *= 2) {
    parallel_for((n + 2 * width - 1) / (2 * width), 1, task, [&](std::size_t pair, std::size_t, std::size_t) {
      const std::size_t begin = pair * 2 * width;
      const auto at = [&](std::size_t i) { return values.begin() + static_cast<std::ptrdiff_t>(std::min(n, i)); };
      std::merge(at(begin), at(begin + width), at(begin + width), at(begin + 2 * width),
                 other.begin() + static_cast<std::ptrdiff_t>(begin), less);
    });
    values.swap(other);
  }
}

}  // namespace lodestone
