// What the levels of a ladder lead one to expect of the next: a level far above it is ruined rather than coarse.
#pragma once

#include <cstddef>
#include <vector>

namespace lodestone::chain::detail {

/// A level as a point of the curve of errors against triangles.
struct CurvePoint {
  std::size_t triangles = 0;
  double error = 0;  ///< measured maximum, model units
};

/// The least error that tells how a curve goes on, of the diagonal. Below it triangles that lie in planes go first, and
/// how many of those there were tells nothing of the rest.
inline constexpr double kLeastTelling = 1e-4;

bool tells(const CurvePoint& point, double diagonal);

/// The largest error that is in line for a level of so many triangles: twice what the curve of the finer levels (the
/// finest first; only those count that tell something) leads one to expect. The error of a surface of n good triangles
/// grows as 1 / n; a curve that grows faster between its last two points is followed with n^-1.5. Never less than twice
/// what a sphere needs with so few triangles, 4 diagonals over n; `of_parts`: four times that, as a surface that is
/// stood for by ever fewer separate parts spends four triangles on each. Never less than a thousandth of the diagonal,
/// which is no ruin. Infinity where no level tells anything.
double most_in_line(const std::vector<CurvePoint>& finer, std::size_t triangles, double diagonal, bool of_parts);

}  // namespace lodestone::chain::detail
