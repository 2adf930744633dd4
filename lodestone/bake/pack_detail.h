// Packing of flat charts into a square.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "lodestone/bake/flat_charts_detail.h"
#include "lodestone/base/task.h"
#include "lodestone/math/vec.h"

namespace lodestone::bake::detail {

/// Where a chart comes to lie: turned by quarters, then moved, in texels, y upward.
struct Placing {
  std::uint32_t quarters = 0;
  Vec2d shift;
};

struct Packing {
  double scale = 0;               ///< texels a model unit
  std::vector<Placing> placings;  ///< one a chart

  Vec2d texel(std::size_t chart, Vec2d p) const;
};

/// Places the charts in a square of `size` texels, `gutter` texels between any two and half of it along the border, at
/// about the largest scale that fits: highest charts first, each where it leaves least room unused between it and the
/// skyline of those that lie there, both with their true outlines ("Tetris packing", Lévy et al., "Least squares
/// conformal maps", 2002); the scale by bisection. Nothing where the gutters alone leave no room.
/// O(charts x columns x columns of a chart) for each scale tried.
std::optional<Packing> pack_charts(const std::vector<FlatChart>& charts, std::uint32_t size, double gutter,
                                   const Task& task);

}  // namespace lodestone::bake::detail
