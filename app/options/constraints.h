// --weight-by, --weights, --lock, --keep-border, --weld, --join, --only, --prune, --keep-area, --keep-parts: where a
// model matters more, what stays, and what may vanish.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/options/command_line.h"
#include "app/options/shared_options.h"
#include "app/options/spec.h"
#include "lodestone/chain/ladder/constraints.h"

namespace lodestone::app {

OptionGroup method_group();

/// What was asked, before the model is known.
struct ConstraintPlan {
  chain::SimplifyConstraints constraints;
  std::optional<LengthArgument> weld, join;
  std::vector<std::string> sphere_places;  ///< where each sphere stands on the command line or in a file
  std::vector<std::string> only_places;    ///< the same for each range of triangles

  bool keep_parts = false;  ///< no part vanishes that was not asked to

  /// With lengths in the model's units, for levels of down to `smallest` triangles (0 = as few as may be). Where the
  /// model is made of thin parts, and nothing was asked, parts may vanish and others grow. `warnings` gets that, and
  /// spheres that hold no vertex. Errors: bad_argument (a unit, and the model has none), bad_format (a triangle that
  /// the model has not), cancelled.
  Result<chain::SimplifyConstraints> for_model(const Model& model, std::size_t smallest,
                                               std::vector<std::string>& warnings, const Task& task) const;
};

/// Reads the options, and the files of --weights and --only. Errors: bad_argument, cannot_read, bad_format (with the
/// line).
Result<ConstraintPlan> constraints_of(const Arguments& arguments, const LengthRules& lengths);

}  // namespace lodestone::app
