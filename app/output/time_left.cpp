#include "app/output/time_left.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace lodestone::app {
namespace {

constexpr double kFirst = 2;  // seconds before anything is told
constexpr double kLeastDone = 0.03;
constexpr double kLately = 0.3;  // "of late" is this share of the time so far
constexpr double kAgree = 1.5;   // both speeds give times left within this factor
constexpr double kAgreeFor = 1;  // seconds that they have to
constexpr double kSettle = 2;    // seconds in which a new estimate takes the place of what was told
constexpr double kGap = 0.05;    // seconds between two samples that are kept

}  // namespace

// The share that was done at `since`, between samples by a line.
double TimeLeft::done_lately(double since) const {
  const auto after = std::find_if(samples_.begin(), samples_.end(), [&](const Sample& s) { return s.time >= since; });
  if (after == samples_.end()) return samples_.back().done;
  if (after == samples_.begin()) return after->done;
  const Sample& before = *(after - 1);
  const double part = (since - before.time) / std::max(1e-9, after->time - before.time);
  return before.done + part * (after->done - before.done);
}

std::optional<double> TimeLeft::after(double now, double done) {
  if (samples_.empty()) samples_.push_back({0, 0});
  const double since = now * (1 - kLately);
  if (now - samples_.back().time >= kGap) samples_.push_back({now, done});
  while (samples_.size() > 2 && samples_[1].time <= since) samples_.pop_front();

  const double lately = done - done_lately(since);
  const bool known = now >= kFirst && done >= kLeastDone && lately > 0;
  const double by_all = known ? (1 - done) * now / done : 0;
  const double by_late = known ? (1 - done) * (now - since) / lately : 0;
  const bool agree = known && by_late <= kAgree * by_all && by_all <= kAgree * by_late;
  if (!agree) {
    agreed_since_ = told_at_ = -1;
    return std::nullopt;
  }
  if (agreed_since_ < 0) agreed_since_ = now;
  if (now - agreed_since_ < kAgreeFor) return std::nullopt;

  const double end = now + std::max(by_all, by_late);
  if (told_at_ < 0) {
    end_ = end;
  } else {
    end_ += (end - end_) * std::min(1.0, (now - told_at_) / kSettle);
  }
  told_at_ = now;
  return std::max(1.0, end_ - now);
}

std::string time_left_text(double seconds) {
  const double step = seconds <= 10 ? 1 : seconds <= 90 ? 5 : seconds <= 3600 ? 60 : 600;
  const auto whole = static_cast<std::uint64_t>(std::ceil(seconds / step - 1e-6) * step);
  if (whole >= 3600) return fmt::format("{} h {:02} min left", whole / 3600, whole % 3600 / 60);
  if (whole > 90) return fmt::format("{} min left", (whole + 59) / 60);
  return fmt::format("{} s left", whole);
}

}  // namespace lodestone::app
