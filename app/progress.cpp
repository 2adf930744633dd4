#include "app/progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>

#include "app/text.h"

namespace lodestone::app {
namespace {

constexpr auto kInterval = std::chrono::milliseconds(100);
constexpr std::size_t kBarCells = 24;

std::size_t terminal_width() {
  winsize size{};
  if (::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col < 20) return 80;
  return size.ws_col;
}

std::string time_left(double elapsed, double done) {
  if (done < 0.02 || elapsed < 0.5) return "";
  const double left = elapsed * (1 - done) / done;
  const auto seconds = static_cast<std::uint64_t>(left + 0.5);
  if (seconds >= 3600) return fmt::format("  {} h {:02} min left", seconds / 3600, seconds % 3600 / 60);
  if (seconds >= 60) return fmt::format("  {} min {:02} s left", seconds / 60, seconds % 60);
  return fmt::format("  {} s left", seconds);
}

}  // namespace

Progress::Progress(bool shown) : shown_(shown), start_(Clock::now()), last_drawn_(start_) {}

Progress::~Progress() { clear(); }

ProgressCallback Progress::callback() {
  if (!shown_) return {};
  return [this](double done, const std::string& label) { update(done, label); };
}

void Progress::set_title(std::string title) {
  const std::lock_guard lock(mutex_);
  title_ = title.empty() ? std::string() : printable(title) + ": ";
}

void Progress::update(double done, const std::string& label) {
  const std::lock_guard lock(mutex_);
  const Clock::time_point now = Clock::now();
  if (now - last_drawn_ < kInterval) return;
  last_drawn_ = now;
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  const auto cells = std::min(kBarCells, static_cast<std::size_t>(done * static_cast<double>(kBarCells)));
  const std::string figures = fmt::format(" [{}{}] {:3.0f} %{}", std::string(cells, '#'),
                                          std::string(kBarCells - cells, '.'), done * 100, time_left(elapsed, done));
  const std::size_t room = terminal_width() - 1;
  const std::string what = cut_to_width(title_ + label, room > figures.size() ? room - figures.size() : 0);
  fmt::print(stderr, "\r\033[K{}{}", what, figures);
  std::fflush(stderr);
  on_screen_ = true;
}

void Progress::clear() {
  const std::lock_guard lock(mutex_);
  if (!on_screen_) return;
  fmt::print(stderr, "\r\033[K");
  std::fflush(stderr);
  on_screen_ = false;
}

}  // namespace lodestone::app
