// Plots of a few lines as inline SVG.
#pragma once

#include <string>
#include <vector>

#include "lodestone/math/vec.h"

namespace lodestone::report {

struct PlotLine {
  std::string name;           ///< for the key and for screen readers; empty: not in the key
  std::vector<Vec2d> points;  ///< drawn in this order, each with a dot
  std::string label;          ///< beside the last point; may be empty
  bool dashed = false;
};

struct Plot {
  std::string title, x_label, y_label;  ///< with units
  bool log_x = false, log_y = false;    ///< points at 0 or below are left out then
  std::vector<PlotLine> lines;
};

/// An <svg> element of 640 x 400 units that takes the width it gets and the colours of the page (classes plot, line-0
/// to line-5); all values stand in its description. Deterministic but for the last digit of logarithms.
std::string svg_of(const Plot& plot);

/// Places of marks on an axis from `least` to `largest`: steps of 1, 2 or 5 times a power of ten, or, logarithmic,
/// powers of ten with 2 and 5 between them where there is room, and even steps where fewer than two of them lie there.
/// At least two where the range allows.
std::vector<double> axis_ticks(double least, double largest, bool logarithmic);

}  // namespace lodestone::report
