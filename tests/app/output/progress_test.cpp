#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "app/output/progress_line.h"
#include "app/output/text.h"
#include "app/output/time_left.h"

namespace lodestone::app {
namespace {

struct Told {
  double now, done;
  std::optional<double> left;
};

// What is told of work that has come as far as done(t) at the time t, ten times a second until `end`.
std::vector<Told> told(double end, const std::function<double(double)>& done) {
  TimeLeft left;
  std::vector<Told> out;
  for (int i = 1; i * 0.1 < end; ++i) out.push_back({i * 0.1, done(i * 0.1), left.after(i * 0.1, done(i * 0.1))});
  return out;
}

TEST(TimeLeft, work_at_an_even_pace_is_told_right_soon_and_counts_down) {
  for (const double end : {8.0, 60.0, 2000.0}) {
    double last = end;
    for (const Told& t : told(end, [&](double now) { return now / end; })) {
      if (t.now < 2) {
        EXPECT_FALSE(t.left);
      }
      if (t.now > std::max(4.0, 0.1 * end)) {
        ASSERT_TRUE(t.left) << end << " s, after " << t.now;
      }
      if (!t.left) continue;
      EXPECT_NEAR(*t.left, std::max(1.0, end - t.now), 0.02 * end + 0.2) << end << " s, after " << t.now;
      EXPECT_LE(*t.left, last + 1e-6);
      last = *t.left;
    }
  }
}

TEST(TimeLeft, nothing_is_told_once_the_pace_has_changed) {
  // Six tenths in two seconds, the rest in forty: no "0 s left" at 60 %, and no counting up.
  double last = 1e9;
  for (const Told& t : told(42, [](double now) { return now < 2 ? 0.3 * now : 0.6 + 0.01 * (now - 2); })) {
    if (t.now > 2.5 && t.now < 20) {
      EXPECT_FALSE(t.left) << "after " << t.now << ": " << t.left.value_or(0);
    }
    if (!t.left) continue;
    EXPECT_GE(*t.left, 1);
    EXPECT_LE(*t.left, last + 0.2) << "after " << t.now;
    last = *t.left;
  }
}

TEST(TimeLeft, work_that_slows_down_is_never_told_to_end_at_once) {
  for (const double power : {0.4, 0.6, 0.8}) {
    for (const Told& t : told(60, [&](double now) { return std::pow(now / 60, power); })) {
      if (t.left) {
        EXPECT_GE(*t.left, 0.6 * (60 - t.now)) << power << ", after " << t.now;
      }
    }
  }
}

TEST(TimeLeft, standing_still_takes_back_what_was_told) {
  const auto all = told(60, [](double now) { return std::min(now, 20.0) / 40; });
  EXPECT_TRUE(all[180].left);
  EXPECT_FALSE(all.back().left);
}

TEST(TimeLeft, the_end_is_told_as_a_second) {
  TimeLeft left;
  std::optional<double> last;
  for (int i = 1; i <= 100; ++i) last = left.after(i * 0.1, i * 0.01);
  EXPECT_EQ(last, 1);
}

TEST(TimeLeft, texts_are_rounded_up) {
  EXPECT_EQ(time_left_text(1), "1 s left");
  EXPECT_EQ(time_left_text(3.2), "4 s left");
  EXPECT_EQ(time_left_text(21), "25 s left");
  EXPECT_EQ(time_left_text(91), "2 min left");
  EXPECT_EQ(time_left_text(3601), "1 h 10 min left");
}

TEST(ProgressLine, all_of_it_where_there_is_room) {
  EXPECT_EQ(progress_line("", "reading", 0.5, "5 s left", 79), "reading [############............]  50 %  5 s left");
  EXPECT_EQ(progress_line("2 of 3, a.ply", "reading", 0, "", 79),
            "2 of 3, a.ply: reading [........................]   0 %");
}

TEST(ProgressLine, the_label_survives_forty_columns) {
  const std::string line =
      progress_line("12 of 20, a rather long name.ply", "preparing to measure", 0.4, "2 min left", 39);
  EXPECT_NE(line.find("preparing to measure"), std::string::npos) << line;
  EXPECT_NE(line.find("40 %"), std::string::npos) << line;
  EXPECT_NE(line.find("2 min left"), std::string::npos) << line;
}

TEST(ProgressLine, no_line_is_wider_than_the_terminal) {
  for (std::size_t width = 8; width < 120; ++width) {
    for (const char* title : {"", "3 of 20, a rather long name with ümläuts.ply"}) {
      for (const char* left : {"", "1 h 10 min left"}) {
        const std::string line = progress_line(title, "comparing pictures", 1, left, width);
        EXPECT_LE(width_of(line), width) << line;
        EXPECT_NE(line.find("100 %"), std::string::npos) << line;
      }
    }
  }
}

}  // namespace
}  // namespace lodestone::app
