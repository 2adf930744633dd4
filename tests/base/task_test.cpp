#include "lodestone/base/task.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace lodestone {
namespace {

TEST(Task, default_does_nothing) {
  const Task task;
  task.advance(0.5);
  task.part(0.5, "x").advance(1);
  EXPECT_FALSE(task.cancelled());
  EXPECT_EQ(task.threads(), 0);
}

TEST(Task, parts_add_up_to_the_whole_even_when_a_callee_reports_nothing) {
  std::vector<double> seen;
  {
    const Task root = Task::root([&](double done, const std::string&) { seen.push_back(done); });
    { const Task silent = root.part(0.25, "silent"); }
    const Task half = root.part(0.5, "half");
    half.part(0.5).advance(1);
    half.advance(0.5);
    root.advance(0.1);
  }
  ASSERT_FALSE(seen.empty());
  for (std::size_t i = 1; i < seen.size(); ++i) EXPECT_GE(seen[i], seen[i - 1]);
  EXPECT_NEAR(seen.back(), 1.0, 1e-12);
}

TEST(Task, cannot_claim_more_than_there_is) {
  double last = 0;
  const Task root = Task::root([&](double done, const std::string&) { last = done; });
  const Task part = root.part(0.5);
  part.advance(3);
  part.part(1).advance(1);
  EXPECT_NEAR(last, 0.5, 1e-12);
}

TEST(Task, cancelling_reaches_every_handle) {
  const Task root = Task::root({}, 3);
  const Task deep = root.part(0.5).part(0.5);
  EXPECT_EQ(deep.threads(), 3);
  deep.cancel();
  EXPECT_TRUE(root.cancelled());
}

TEST(Task, what_is_dropped_when_cancelled_does_not_count_as_done) {
  double last = 0;
  const Task root = Task::root([&](double done, const std::string&) { last = done; });
  {
    const Task part = root.part(0.5, "reading");
    part.advance(0.5);
    root.cancel();
  }
  EXPECT_EQ(last, 0.25);
}

TEST(Task, labels_are_inherited) {
  std::string label;
  const Task root = Task::root([&](double, const std::string& l) { label = l; });
  root.part(0.5, "reading").part(0.5).advance(1);
  EXPECT_EQ(label, "reading");
}

TEST(Task, what_begins_is_told_before_any_of_it_is_done) {
  std::string label;
  double last = -1;
  const Task root = Task::root([&](double done, const std::string& l) {
    label = l;
    last = done;
  });
  const Task part = root.part(0.5, "reading");
  EXPECT_EQ(label, "reading");
  EXPECT_EQ(last, 0);
}

}  // namespace
}  // namespace lodestone
