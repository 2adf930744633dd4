// Level and Ladder: an original and its coarser versions, each with its error.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "lodestone/core/model.h"

namespace lodestone {

/// How far an error can be trusted.
enum class ErrorKind {
  estimated,  ///< the method's own figure
  measured,   ///< sampled on both surfaces (at least 200,000 a direction, and all vertices)
  bounded,    ///< certified: the true distance is not larger
};

/// "estimated", "measured" or "bounded".
const char* to_string(ErrorKind kind);

/// Distance of a level to the original, model units (world space of the default scene).
struct LevelError {
  double error = 0;           ///< largest measured_error of this and all finer levels: never falls along a ladder
  double measured_error = 0;  ///< two-sided maximum distance: its bound where kind says so, else the largest found
  double mean_error = 0;      ///< half the sum of both directions' means, over area-weighted samples
  double rms_error = 0;       ///< root of half the sum of both directions' mean squares
  double diagonal = 0;        ///< of the original's bounding box; relative errors are divided by it
  ErrorKind kind = ErrorKind::measured;
  std::uint64_t samples = 0;  ///< a direction

  double relative(double value) const { return diagonal > 0 ? value / diagonal : 0; }
};

struct Level {
  Model model;
  LevelError error;
  std::size_t triangles = 0;       ///< drawn, all instances
  std::size_t vanished_parts = 0;  ///< drawn pieces of the original that have nothing left here
  std::string method;              ///< how it was made: "original", "edge collapse"
  double seconds = 0;              ///< wall time to make and measure it
};

/// levels[0] is the original itself (error 0); its model is left empty and `original` used instead.
struct Ladder {
  Model original;
  std::vector<Level> levels;

  const Model& model(std::size_t level) const { return level == 0 ? original : levels[level].model; }
};

/// For ladders that come into one file: all levels choose from the original's materials, to which theirs are added, and
/// have its convention for the origin of texture coordinates. O(levels' texture coordinates and materials).
void share_materials(Ladder& ladder);

}  // namespace lodestone
