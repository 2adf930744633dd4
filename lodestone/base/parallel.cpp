#include "lodestone/base/parallel.h"

#include <atomic>
#include <exception>
#include <limits>
#include <mutex>
#include <thread>

#ifndef LODESTONE_STD_THREADS
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>
#endif

namespace lodestone {

#ifndef LODESTONE_STD_THREADS

struct ThreadLimit::Control {
  tbb::global_control control;  // built in place: a copy would end the limit with its original
  explicit Control(std::size_t threads) : control(tbb::global_control::max_allowed_parallelism, threads) {}
};

ThreadLimit::ThreadLimit(int threads) {
  control_ = std::make_unique<Control>(threads > 0 ? static_cast<std::size_t>(threads)
                                                   : std::max<std::size_t>(1, std::thread::hardware_concurrency()));
}

namespace parallel_detail {

void run_chunks(std::size_t chunks, ChunkFunction function, void* context, const Task& task) {
  const int threads = task.threads();
  if (chunks <= 1 || threads == 1) {
    for (std::size_t chunk = 0; chunk < chunks; ++chunk) function(context, chunk);
    return;
  }
  const auto loop = [&] {
    tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t chunk) { function(context, chunk); });
  };
  if (threads <= 0) {
    loop();
  } else {
    tbb::task_arena arena(threads);
    arena.execute(loop);
  }
}

}  // namespace parallel_detail

#else  // ThreadSanitizer cannot see into the packaged oneTBB: the same chunks on plain threads.

struct ThreadLimit::Control {};

ThreadLimit::ThreadLimit(int) {}

namespace parallel_detail {

namespace {
thread_local bool inside_loop = false;  // a loop inside a loop runs in the caller, or threads would multiply
}

void run_chunks(std::size_t chunks, ChunkFunction function, void* context, const Task& task) {
  const std::size_t wanted = task.threads() > 0 ? static_cast<std::size_t>(task.threads()) : 4;
  const std::size_t threads = inside_loop ? 1 : std::min(chunks, wanted);
  std::atomic<std::size_t> next{0};
  std::exception_ptr thrown;
  std::mutex mutex;
  const auto work = [&] {
    const bool outer = std::exchange(inside_loop, true);
    try {
      for (std::size_t chunk = next++; chunk < chunks; chunk = next++) function(context, chunk);
    } catch (...) {
      const std::lock_guard lock(mutex);
      thrown = std::current_exception();
    }
    inside_loop = outer;
  };
  std::vector<std::thread> pool;
  for (std::size_t i = 1; i < threads; ++i) pool.emplace_back(work);
  work();
  for (std::thread& thread : pool) thread.join();
  if (thrown) std::rethrow_exception(thrown);
}

}  // namespace parallel_detail

#endif

ThreadLimit::~ThreadLimit() = default;

std::uint64_t exclusive_scan(std::vector<std::uint32_t>& values, const Task& caller) {
  constexpr std::size_t kChunk = std::size_t{1} << 16;
  // Not the caller's task: half a scan would be offsets that lead astray, and a whole one takes no time.
  const Task task = Task::root({}, caller.threads());
  std::vector<std::uint64_t> start((values.size() + kChunk - 1) / kChunk);
  parallel_for(values.size(), kChunk, task, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
    std::uint64_t sum = 0;
    for (std::size_t i = begin; i < end; ++i) sum += values[i];
    start[chunk] = sum;
  });
  std::uint64_t total = 0;
  for (std::uint64_t& s : start) total += std::exchange(s, total);
  parallel_for(values.size(), kChunk, task, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
    std::uint64_t sum = start[chunk];
    for (std::size_t i = begin; i < end; ++i) sum += std::exchange(values[i], static_cast<std::uint32_t>(sum));
  });
  return total;
}

}  // namespace lodestone
