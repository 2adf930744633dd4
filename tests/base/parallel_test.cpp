#include "lodestone/base/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <numeric>

#include "lodestone/base/random.h"

namespace lodestone {
namespace {

TEST(Parallel, every_index_once_for_any_thread_count) {
  for (const int threads : {1, 2, 7}) {
    const Task task = Task::root({}, threads);
    std::vector<std::atomic<int>> hits(10'001);
    parallel_for(hits.size(), 100, task, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
      EXPECT_EQ(begin, chunk * 100);
      for (std::size_t i = begin; i < end; ++i) ++hits[i];
    });
    for (const auto& h : hits) EXPECT_EQ(h, 1);
  }
}

TEST(Parallel, floating_sums_are_the_same_for_any_thread_count) {
  const auto sum = [](int threads) {
    return parallel_reduce(
        100'000, 1000, Task::root({}, threads), 0.0,
        [](std::size_t begin, std::size_t end) {
          double s = 0;
          for (std::size_t i = begin; i < end; ++i) s += random_unit(1, i) * 1e-3;
          return s;
        },
        [](double a, double b) { return a + b; });
  };
  const double one = sum(1);
  EXPECT_EQ(one, sum(2));
  EXPECT_EQ(one, sum(7));
}

TEST(Parallel, a_cancelled_loop_leaves_chunks_out) {
  const Task task = Task::root({}, 2);
  std::atomic<int> ran = 0;
  parallel_for(1000, 1, task, [&](std::size_t, std::size_t, std::size_t) {
    ++ran;
    task.cancel();
  });
  EXPECT_LT(ran, 1000);
}

TEST(Parallel, scan_of_many_chunks) {
  std::vector<std::uint32_t> values(200'000);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<std::uint32_t>(random_bits(2, i) % 5);
  std::vector<std::uint32_t> expected(values.size());
  std::exclusive_scan(values.begin(), values.end(), expected.begin(), 0U);
  const std::uint64_t total = std::accumulate(values.begin(), values.end(), std::uint64_t{0});
  std::vector<std::uint32_t> again = values;
  EXPECT_EQ(exclusive_scan(values), total);
  EXPECT_EQ(values, expected);
  const Task cancelled = Task::root({});
  cancelled.cancel();
  EXPECT_EQ(exclusive_scan(again, cancelled), total) << "offsets hold even when the task is cancelled";
  EXPECT_EQ(again, expected);
}

TEST(Parallel, sort_is_stable) {
  for (const std::size_t n : {std::size_t{0}, std::size_t{1}, std::size_t{65'537}, std::size_t{300'000}}) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> values(n);
    for (std::size_t i = 0; i < n; ++i) {
      values[i] = {static_cast<std::uint32_t>(random_bits(3, i) % 100), static_cast<std::uint32_t>(i)};
    }
    auto expected = values;
    const auto less = [](const auto& a, const auto& b) { return a.first < b.first; };
    std::stable_sort(expected.begin(), expected.end(), less);
    parallel_sort(values, {}, less);
    EXPECT_EQ(values, expected);
  }
}

}  // namespace
}  // namespace lodestone
