#include "app/output/progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>

#include "app/output/progress_line.h"
#include "app/output/text.h"

namespace lodestone::app {
namespace {

constexpr auto kInterval = std::chrono::milliseconds(100);

std::size_t terminal_width() {
  winsize size{};
  if (::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col < 20) return 80;
  return size.ws_col;
}

}  // namespace

Progress::Progress(Terminal terminal) : terminal_(terminal), start_(Clock::now()), last_drawn_(start_) {}

Progress::~Progress() { clear(); }

ProgressCallback Progress::callback() {
  return [this](double done, const std::string& label) { update(done, label); };
}

void Progress::set_title(std::string title) {
  const std::lock_guard lock(mutex_);
  title_ = printable(title);
}

void Progress::update(double done, const std::string& label) {
  const std::lock_guard lock(mutex_);
  done_ = done;
  if (!label.empty() && label_ != label) label_ = label;
  if (terminal_ == Terminal::none) return;
  const Clock::time_point now = Clock::now();
  if (now - last_drawn_ < kInterval) return;
  last_drawn_ = now;
  const std::optional<double> left = time_left_.after(std::chrono::duration<double>(now - start_).count(), done);
  const std::string line =
      progress_line(title_, label, done, left ? time_left_text(*left) : std::string(), terminal_width() - 1);
  erase();
  fmt::print(stderr, "{}", line);
  std::fflush(stderr);
  on_screen_ = width_of(line);
}

// Leaves the cursor at the beginning of the line.
void Progress::erase() {
  if (terminal_ == Terminal::full) {
    fmt::print(stderr, "\r\033[K");
  } else {
    fmt::print(stderr, "\r{}\r", std::string(on_screen_, ' '));
  }
}

void Progress::clear() {
  const std::lock_guard lock(mutex_);
  if (on_screen_ == 0) return;
  erase();
  std::fflush(stderr);
  on_screen_ = 0;
}

std::string Progress::at_work() const {
  const std::lock_guard lock(mutex_);
  if (label_.empty()) return {};
  const std::string title = title_.empty() ? std::string() : fmt::format(" ({})", title_);
  return fmt::format("{}{}, {:.0f} % done", label_, title, done_ * 100);
}

}  // namespace lodestone::app
