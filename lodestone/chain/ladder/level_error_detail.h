// What a level's measurement says of it.
#pragma once

#include <algorithm>

#include "lodestone/core/level.h"
#include "lodestone/measure/distance.h"

namespace lodestone::chain::detail {

/// The same for levels that were made here, which need not be validated.
inline measure::DistanceOptions of_valid(measure::DistanceOptions options) {
  options.input = Input::valid;
  return options;
}

/// `finer` is the error of the level before, as errors never fall along a ladder; 0 for the first.
inline LevelError level_error(const measure::Distance& d, double finer = 0) {
  LevelError e;
  e.measured_error = d.trusted_max();
  e.error = std::max(e.measured_error, finer);
  e.mean_error = d.mean;
  e.rms_error = d.rms;
  e.diagonal = d.diagonal;
  e.kind = d.is_bounded ? ErrorKind::bounded : ErrorKind::measured;
  e.samples = d.samples;
  return e;
}

}  // namespace lodestone::chain::detail
