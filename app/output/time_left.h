// How long work will still take, from how far it has come.
#pragma once

#include <deque>
#include <optional>
#include <string>

namespace lodestone::app {

/// Fed with times and shares done, says how long it will still take, or nothing while that can't be told: in the first
/// seconds, and as long as the speed of late differs from that of the whole run, for then shares and time don't go
/// together. What is told counts down steadily and is never below a second while there is work left. Times in seconds
/// since the work began, which never fall; shares from 0 to 1, which never fall either.
class TimeLeft {
 public:
  /// The time left after this, in seconds.
  std::optional<double> after(double now, double done);

 private:
  struct Sample {
    double time, done;
  };
  double done_lately(double since) const;

  std::deque<Sample> samples_;
  double agreed_since_ = -1;  // below 0: both speeds don't agree
  double end_ = 0;            // when the work is told to end
  double told_at_ = -1;       // below 0: nothing is told
};

/// "25 s left", rounded up so that it does not flicker: to 1 s below 10 s, then to 5 s, 1 min, 10 min.
std::string time_left_text(double seconds);

}  // namespace lodestone::app
