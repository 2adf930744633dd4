#include "app/output/progress_line.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/output/text.h"

namespace lodestone::app {
namespace {

constexpr std::size_t kBarCells = 24, kLeastBarCells = 6;
constexpr std::size_t kFrame = 3;  // " [" and "]"

std::string bar(double done, std::size_t cells) {
  const std::size_t full = std::min(cells, static_cast<std::size_t>(done * static_cast<double>(cells)));
  return fmt::format(" [{}{}]", std::string(full, '#'), std::string(cells - full, '.'));
}

}  // namespace

std::string progress_line(std::string_view title, std::string_view label, double done, std::string_view left,
                          std::size_t width) {
  std::string what = title.empty() ? std::string(label) : fmt::format("{}: {}", title, label);
  std::string figures = fmt::format(" {:3.0f} %", done * 100);
  const std::string time = left.empty() ? std::string() : fmt::format("  {}", left);
  const std::size_t needed = figures.size() + time.size();
  if (width_of(what) + needed > width) what = label;
  if (width_of(what) + needed <= width) figures += time;
  const std::size_t taken = width_of(what) + figures.size();
  if (taken > width) return cut_to_width(what, width > figures.size() ? width - figures.size() : 0) + figures;
  const std::size_t room = width - taken;
  if (room < kFrame + kLeastBarCells) return what + figures;
  return what + bar(done, std::min(kBarCells, room - kFrame)) + figures;
}

}  // namespace lodestone::app
