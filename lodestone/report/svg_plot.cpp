// A plot of a few lines as inline SVG, which takes its colours from the page.
//
// 1. Axis, axis_of(): from values to places on the picture, linear or logarithmic, with some air around the values.
// 2. tick_text(), add_axes(), add_line(), add_key(): grid and marks, lines with a dot a point, and the key.
// 3. description(): all values in words, for those who can't see the plot.
// 4. power_ticks(), even_ticks(), axis_ticks(): where marks lie: powers of ten, or steps of 1, 2 or 5 times one.
// 5. svg_of(): the whole.
// Invariants: points that a logarithmic axis can't show are left out; names are escaped. pow and log10 are libm's, so a
// place may differ in its last digit between machines. Cost: O(points).
#include "lodestone/report/svg_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "lodestone/report/html_text.h"

namespace lodestone::report {

namespace {

constexpr double kWidth = 640, kHeight = 400, kLeft = 84, kRight = 24, kTop = 38, kBottom = 56;
constexpr std::size_t kColors = 6;

struct Axis {
  double least = 0, largest = 1;
  bool logarithmic = false;
  double from = 0, to = 1;  // on the picture

  double place(double value) const {
    const double share =
        logarithmic ? std::log10(value / least) / std::log10(largest / least) : (value - least) / (largest - least);
    return from + (to - from) * share;
  }
  bool shows(double value) const { return std::isfinite(value) && (!logarithmic || value > 0); }
};

// With some air around the values.
Axis axis_of(const std::vector<double>& values, bool logarithmic, double from, double to) {
  Axis axis{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(), logarithmic, from, to};
  for (const double v : values) {
    if (!axis.shows(v)) continue;
    axis.least = std::min(axis.least, v);
    axis.largest = std::max(axis.largest, v);
  }
  if (!(axis.least <= axis.largest)) axis.least = axis.largest = 1;
  if (logarithmic) {
    const double air = std::max(1.3, std::pow(axis.largest / axis.least, 0.06));
    axis.least /= air;
    axis.largest *= air;
  } else {
    if (axis.largest == axis.least) axis.largest += axis.least != 0 ? std::abs(axis.least) : 1;
    axis.least = std::min(0.0, axis.least);
    axis.largest += 0.06 * (axis.largest - axis.least);
  }
  return axis;
}

std::string tick_text(double value) {
  const double size = std::abs(value);
  if (size >= 1e9) return fmt::format("{:.4g}G", value / 1e9);
  if (size >= 1e6) return fmt::format("{:.4g}M", value / 1e6);
  if (size >= 1e3) return fmt::format("{:.4g}k", value / 1e3);
  return fmt::format("{:.4g}", value);
}

void add_axes(std::string& svg, const Plot& plot, const Axis& x, const Axis& y) {
  for (const double tick : axis_ticks(y.least, y.largest, y.logarithmic)) {
    const double at = y.place(tick);
    svg += fmt::format(R"(<line class="grid" x1="{:.1f}" y1="{:.1f}" x2="{:.1f}" y2="{:.1f}"/>)", kLeft, at,
                       kWidth - kRight, at);
    svg += fmt::format(R"(<text class="tick" x="{:.1f}" y="{:.1f}" text-anchor="end">{}</text>)", kLeft - 8, at + 4,
                       tick_text(tick));
  }
  for (const double tick : axis_ticks(x.least, x.largest, x.logarithmic)) {
    const double at = x.place(tick);
    svg += fmt::format(R"(<line class="grid" x1="{:.1f}" y1="{:.1f}" x2="{:.1f}" y2="{:.1f}"/>)", at, kTop, at,
                       kHeight - kBottom);
    svg += fmt::format(R"(<text class="tick" x="{:.1f}" y="{:.1f}" text-anchor="middle">{}</text>)", at,
                       kHeight - kBottom + 18, tick_text(tick));
  }
  svg += fmt::format(R"(<path class="axis" d="M{:.1f} {:.1f}V{:.1f}H{:.1f}"/>)", kLeft, kTop, kHeight - kBottom,
                     kWidth - kRight);
  svg += fmt::format(R"(<text class="label" x="{:.1f}" y="{:.1f}" text-anchor="middle">{}</text>)",
                     (kLeft + kWidth - kRight) / 2, kHeight - 14, escaped(plot.x_label));
  // Above its axis, not turned: that takes no width from narrow screens.
  svg += fmt::format(R"(<text class="label" x="8" y="20">{}</text>)", escaped(plot.y_label));
}

void add_line(std::string& svg, const PlotLine& line, std::size_t number, const Axis& x, const Axis& y) {
  std::string path, dots;
  Vec2d last{};
  for (const Vec2d& p : line.points) {
    if (!x.shows(p.x) || !y.shows(p.y)) continue;
    last = {x.place(p.x), y.place(p.y)};
    path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", last.x, last.y);
    dots += fmt::format(R"(<circle cx="{:.1f}" cy="{:.1f}" r="3.5"/>)", last.x, last.y);
  }
  if (path.empty()) return;
  svg += fmt::format(R"(<g class="line-{}"><path d="{}"{}/>{})", number % kColors, path,
                     line.dashed ? R"( stroke-dasharray="6 4")" : "", dots);
  if (!line.label.empty()) {
    svg += fmt::format(R"(<text x="{:.1f}" y="{:.1f}">{}</text>)", last.x + 6, last.y - 6, escaped(line.label));
  }
  svg += "</g>";
}

void add_key(std::string& svg, const Plot& plot) {
  double y = kTop + 16;
  for (std::size_t i = 0; i < plot.lines.size(); ++i) {
    if (plot.lines[i].name.empty() || !plot.lines[i].label.empty()) continue;
    svg += fmt::format(R"(<g class="line-{}"><path d="M{:.1f} {:.1f}h24"{}/></g>)", i % kColors, kWidth - kRight - 180,
                       y - 4, plot.lines[i].dashed ? R"( stroke-dasharray="6 4")" : "");
    svg += fmt::format(R"(<text class="key" x="{:.1f}" y="{:.1f}">{}</text>)", kWidth - kRight - 148, y,
                       escaped(plot.lines[i].name));
    y += 24;  // room for large letters
  }
}

// All values in words, for those who can't see them.
std::string description(const Plot& plot) {
  std::string text = fmt::format("{} over {}.", plot.y_label, plot.x_label);
  for (const PlotLine& line : plot.lines) {
    text += fmt::format(" {}:", line.name.empty() ? line.label : line.name);
    for (const Vec2d& p : line.points) text += fmt::format(" {:.4g} at {:.4g};", p.y, p.x);
  }
  return text;
}

// Powers of ten; twice and five times them, too, where there is room.
std::vector<double> power_ticks(double least, double largest) {
  std::vector<double> ticks;
  if (!(least > 0) || !std::isfinite(largest)) return ticks;
  const auto add = [&](double tick) {
    if (tick >= least * (1 - 1e-9) && tick <= largest * (1 + 1e-9)) ticks.push_back(tick);
  };
  const int low = static_cast<int>(std::floor(std::log10(least))),
            high = static_cast<int>(std::ceil(std::log10(largest)));
  const int every = std::max(1, (high - low) / 6);
  const bool wide = std::log10(largest / least) > 2;  // no room between the powers
  for (int power = low; power <= high; power += every) {
    const double decade = std::pow(10.0, power);
    add(decade);
    if (wide) continue;
    add(2 * decade);
    add(5 * decade);
  }
  return ticks;
}

// Steps of 1, 2 or 5 times a power of ten.
std::vector<double> even_ticks(double least, double largest) {
  std::vector<double> ticks;
  const double raw = (largest - least) / 5;
  if (!(raw > 0) || !std::isfinite(raw)) return ticks;
  const double decade = std::pow(10.0, std::floor(std::log10(raw)));
  const double step = raw <= 1.5 * decade   ? decade
                      : raw <= 3.5 * decade ? 2 * decade
                      : raw <= 7.5 * decade ? 5 * decade
                                            : 10 * decade;
  for (double tick = std::ceil(least / step); tick * step <= largest; ++tick) ticks.push_back(tick * step);
  return ticks;
}

}  // namespace

std::vector<double> axis_ticks(double least, double largest, bool logarithmic) {
  if (!logarithmic) return even_ticks(least, largest);
  std::vector<double> ticks = power_ticks(least, largest);
  return ticks.size() < 2 && least > 0 ? even_ticks(least, largest) : ticks;
}

std::string svg_of(const Plot& plot) {
  std::vector<double> xs, ys;
  for (const PlotLine& line : plot.lines) {
    for (const Vec2d& p : line.points) {
      if ((plot.log_x && !(p.x > 0)) || (plot.log_y && !(p.y > 0))) continue;
      xs.push_back(p.x);
      ys.push_back(p.y);
    }
  }
  const Axis x = axis_of(xs, plot.log_x, kLeft, kWidth - kRight), y = axis_of(ys, plot.log_y, kHeight - kBottom, kTop);
  std::string svg =
      fmt::format(R"(<svg class="plot" viewBox="0 0 {:.0f} {:.0f}" role="img"><title>{}</title><desc>{}</desc>)",
                  kWidth, kHeight, escaped(plot.title), escaped(description(plot)));
  add_axes(svg, plot, x, y);
  for (std::size_t i = 0; i < plot.lines.size(); ++i) add_line(svg, plot.lines[i], i, x, y);
  add_key(svg, plot);
  return svg + "</svg>\n";
}

}  // namespace lodestone::report
