#include <fmt/format.h>

#include <algorithm>

#include "lodestone/report/html_text.h"
#include "lodestone/report/report_plots_detail.h"
#include "lodestone/report/svg_plot.h"

namespace lodestone::report::detail {

namespace {

std::string figure(const Plot& plot, const std::string& caption) {
  return fmt::format("<figure>{}<figcaption><strong>{}.</strong> {}</figcaption></figure>\n", svg_of(plot),
                     escaped(plot.title), caption);
}

// Axes always say in what they are.
std::string axis_unit(const ReportData& data) { return data.unit.empty() ? "model units" : data.unit; }

Plot error_plot(const ReportData& data) {
  Plot plot{
      "Error over triangles", "triangles", with_unit("distance to the original", axis_unit(data)), true, true, {}};
  PlotLine largest{"largest", {}, "", false}, mean{"mean", {}, "", true};
  for (const ReportLevel& level : data.levels) {
    const auto triangles = static_cast<double>(level.triangles);
    if (level.error.error > 0) largest.points.push_back({triangles, level.error.error});
    if (level.error.mean_error > 0) mean.points.push_back({triangles, level.error.mean_error});
  }
  plot.lines = {std::move(largest), std::move(mean)};
  return plot;
}

Plot size_plot(const ReportData& data) {
  Plot plot{"Size over triangles", "triangles", "bytes", true, true, {}};
  PlotLine size{"", {}, "", false};
  for (const ReportLevel& level : data.levels) {
    size.points.push_back({static_cast<double>(level.triangles), static_cast<double>(level.bytes)});
  }
  plot.lines = {std::move(size)};
  return plot;
}

// A line a level: what its error covers from where; the marks in the middle are where that is one pixel.
Plot pixel_plot(const ReportData& data) {
  Plot plot{"Error on the screen over distance", with_unit("distance", axis_unit(data)), "pixels", true, true, {}};
  for (std::size_t i = 1; i < data.levels.size(); ++i) {
    const double error = data.levels[i].error.error;
    const double from = measure::switch_distance(error, 1, data.view);
    if (!(from > 0)) continue;
    PlotLine line{fmt::format("level {}", i), {}, fmt::format("{}", i), false};
    for (const double share : {0.25, 1.0, 4.0}) {
      line.points.push_back({from * share, measure::error_to_pixels(error, from * share, data.view)});
    }
    plot.lines.push_back(std::move(line));
  }
  if (plot.lines.empty()) return plot;
  const double nearest = plot.lines.front().points.front().x, farthest = plot.lines.back().points.back().x;
  plot.lines.push_back({"one pixel", {{nearest, 1}, {farthest, 1}}, "", true});
  return plot;
}

}  // namespace

std::string plots(const ReportData& data) {
  if (data.levels.size() < 2) return "<p>There is only the original.</p>\n";
  std::string html = "<div class=\"plots\">\n";
  html +=
      figure(error_plot(data), "The largest and the mean distance to the original. Levels without any are left out.");
  html += figure(size_plot(data), "What each level takes in the file.");
  if (data.levels.back().error.error > 0) {
    html += figure(
        pixel_plot(data),
        fmt::format("How many pixels each level’s error covers on a screen of {} lines; the middle dot of a line "
                    "is its switch distance, one pixel.",
                    data.view.height_px));
  }
  return html + "</div>\n";
}

}  // namespace lodestone::report::detail
