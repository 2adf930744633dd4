// Packing of flat charts into a square texture at about the largest scale that fits.
//
// Method: "Tetris packing" (B. Lévy et al., Least Squares Conformal Maps, 2002 [levy-2002]). Charts come by falling
// height; each goes where it leaves least room unused between its lower outline and the skyline of those already there.
// Both are heights by column, so charts nest into each other's true outlines.
// 1. Packer(): the order of the charts, and at most kMostColumns columns of whole texels.
// 2. at_scale(): places all charts at one scale, or tells that they don't fit.
// 3. make_profile(): a chart's lower and upper outline by column, with half a gutter all around.
// 4. place(): tries four orientations at every column. The cost of a place is the room left unused below the chart,
//    plus `height_` times how high it reaches.
// 5. pack_charts(): the largest scale that fits, by bisection; then, unless there are many charts, whether another
//    weight of the height (kHeights) allows a larger one.
// Invariants: any two charts are a gutter apart, and half of one from the border. One thread; of equal places the first
// is taken, and the sort is stable. Cost: for each scale tried, charts x columns x a chart's own columns.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "lodestone/bake/pack_detail.h"

namespace lodestone::bake::detail {

namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();
constexpr std::size_t kMostColumns = 512;
constexpr std::size_t kMany = 4096;  // with more charts, time counts more than the last per cent of the scale
constexpr double kPrecision = 1.004, kPrecisionOfMany = 1.03;  // of the scale
constexpr double kStep = 1.01;                                 // by which other weights of the height must be better
// What lying high counts beside room left unused below; which serves best differs from model to model.
constexpr std::array<double, 4> kHeights{2, 0.5, 1, 8};

Vec2d turned(Vec2d p, std::uint32_t quarters) {
  switch (quarters) {
    case 1:
      return {-p.y, p.x};
    case 2:
      return {-p.x, -p.y};
    case 3:
      return {p.y, -p.x};
    default:
      return p;
  }
}

// The lower left corner of the box [0, size] after a turn.
Vec2d corner_of(Vec2d size, std::uint32_t quarters) {
  const Vec2d other = turned(size, quarters);
  return {std::min(0.0, other.x), std::min(0.0, other.y)};
}

// A chart as the columns of the square see it, with half a gutter all around.
struct Profile {
  std::vector<double> low, high;
  double top = 0;
};

class Packer {
 public:
  Packer(const std::vector<FlatChart>& charts, std::uint32_t size, double gutter)
      : charts_(charts), size_(size), half_(gutter / 2), order_(charts.size()) {
    cell_ = std::max(1.0, std::ceil(size_ / static_cast<double>(kMostColumns)));
    columns_ = static_cast<std::size_t>(size_ / cell_);
    std::iota(order_.begin(), order_.end(), 0U);
    std::stable_sort(order_.begin(), order_.end(),
                     [&](std::uint32_t l, std::uint32_t r) { return charts[l].size.y > charts[r].size.y; });
  }

  std::optional<Packing> at_scale(double scale, double height, const Task& task) {
    height_ = height;
    Packing packing{scale, std::vector<Placing>(charts_.size())};
    skyline_.assign(columns_, 0.0);
    for (const std::uint32_t c : order_) {
      if (task.cancelled()) return std::nullopt;
      if (!place(charts_[c], scale, packing.placings[c])) return std::nullopt;
    }
    return packing;
  }

 private:
  // False where the chart is wider than the square.
  bool make_profile(const FlatChart& chart, double scale, std::uint32_t quarters, Profile& out) const {
    const Vec2d turned_size = turned(chart.size, quarters);
    const Vec2d corner = corner_of(chart.size, quarters);
    const double width = std::abs(turned_size.x) * scale + 2 * half_;
    const auto columns = static_cast<std::size_t>(std::ceil(width / cell_));
    if (columns > columns_) return false;
    out.low.assign(columns, kFar);
    out.high.assign(columns, -kFar);
    out.top = std::abs(turned_size.y) * scale + 2 * half_;
    for (const auto& [from, to] : chart.outline) {
      Vec2d a = turned(from, quarters), b = turned(to, quarters);
      a = {(a.x - corner.x) * scale + half_, (a.y - corner.y) * scale + half_};
      b = {(b.x - corner.x) * scale + half_, (b.y - corner.y) * scale + half_};
      if (a.x > b.x) std::swap(a, b);
      const auto first = static_cast<std::size_t>(std::max(0.0, (a.x - half_) / cell_));
      const auto last = std::min(columns - 1, static_cast<std::size_t>((b.x + half_) / cell_));
      for (std::size_t i = first; i <= last; ++i) {
        // The part of the segment that is within half a gutter of the column.
        const double left = static_cast<double>(i) * cell_ - half_, right = static_cast<double>(i + 1) * cell_ + half_;
        const auto y_at = [&](double x) {
          return b.x > a.x ? a.y + (b.y - a.y) * std::clamp((x - a.x) / (b.x - a.x), 0.0, 1.0) : a.y;
        };
        const double y0 = y_at(left), y1 = b.x > a.x ? y_at(right) : b.y;
        out.low[i] = std::min({out.low[i], y0 - half_, y1 - half_});
        out.high[i] = std::max({out.high[i], y0 + half_, y1 + half_});
      }
    }
    return true;
  }

  bool place(const FlatChart& chart, double scale, Placing& placing) {
    double best_cost = kFar, best_y = 0;
    std::size_t best_column = 0;
    for (std::uint32_t quarters = 0; quarters < 4; ++quarters) {
      if (!make_profile(chart, scale, quarters, profile_)) continue;
      const std::size_t width = profile_.low.size();
      for (std::size_t x = 0; x + width <= columns_; ++x) {
        double y = 0, gap = 0;
        for (std::size_t i = 0; i < width; ++i) y = std::max(y, skyline_[x + i] - profile_.low[i]);
        if (y + profile_.top > size_) continue;
        for (std::size_t i = 0; i < width; ++i) gap += y + profile_.low[i] - skyline_[x + i];
        const double cost = gap * cell_ + height_ * (y + profile_.top) * static_cast<double>(width) * cell_;
        if (cost < best_cost) {
          best_cost = cost;
          best_column = x;
          best_y = y;
          placing.quarters = quarters;
          best_ = profile_;
        }
      }
    }
    if (best_cost == kFar) return false;
    for (std::size_t i = 0; i < best_.high.size(); ++i) skyline_[best_column + i] = best_y + best_.high[i];
    const Vec2d corner = corner_of(chart.size, placing.quarters);
    placing.shift = {static_cast<double>(best_column) * cell_ + half_ - corner.x * scale,
                     best_y + half_ - corner.y * scale};
    return true;
  }

  const std::vector<FlatChart>& charts_;
  double size_, half_, cell_, height_ = 1;
  std::size_t columns_;
  std::vector<std::uint32_t> order_;
  std::vector<double> skyline_;
  Profile profile_, best_;
};

}  // namespace

Vec2d Packing::texel(std::size_t chart, Vec2d p) const {
  const Placing& at = placings[chart];
  const Vec2d q = turned(p, at.quarters);
  return {q.x * scale + at.shift.x, q.y * scale + at.shift.y};
}

std::optional<Packing> pack_charts(const std::vector<FlatChart>& charts, std::uint32_t size, double gutter,
                                   const Task& task) {
  Packer packer(charts, size, gutter);
  double area = 0, longest = 0;
  for (const FlatChart& chart : charts) {
    area += chart.area;
    longest = std::max(longest, chart.size.y);
  }
  // A square all full; for charts without area, the longest along a side.
  double high = area > 0 ? size / std::sqrt(area) : longest > 0 ? size / longest : 1;
  double low = high * 0.75;
  std::optional<Packing> best = packer.at_scale(low, kHeights[0], task);
  for (int i = 0; !best && i < 40 && !task.cancelled(); ++i) {
    high = low;
    low *= 0.8;
    best = packer.at_scale(low, kHeights[0], task);
  }
  const bool many = charts.size() > kMany;
  while (best && high > low * (many ? kPrecisionOfMany : kPrecision) && !task.cancelled()) {
    const double middle = (low + high) / 2;
    if (std::optional<Packing> packing = packer.at_scale(middle, kHeights[0], task)) {
      best = std::move(packing);
      low = middle;
    } else {
      high = middle;
    }
  }
  for (std::size_t i = 1; best && !many && i < kHeights.size(); ++i) {
    while (std::optional<Packing> packing = packer.at_scale(best->scale * kStep, kHeights[i], task)) {
      best = std::move(packing);
    }
  }
  return best;
}

}  // namespace lodestone::bake::detail
