// --weight-by, --weights, --lock, --keep-border, --weld: where a model matters more, and what stays.
#pragma once

#include <optional>

#include "app/command_line.h"
#include "app/shared_options.h"
#include "app/spec.h"
#include "lodestone/chain/influence.h"

namespace lodestone::app {

OptionGroup method_group();

/// What was asked, before the model is known.
struct InfluencePlan {
  chain::Influence influence;
  std::optional<LengthArgument> weld;

  /// With lengths in the model's units. Errors: bad_argument (a unit, and the model has none).
  Result<chain::Influence> for_model(const Model& model) const;
};

/// Reads the options, and the file of --weights. Errors: bad_argument, cannot_read, bad_format (with the line).
Result<InfluencePlan> influence_of(const Arguments& arguments, const LengthRules& lengths);

}  // namespace lodestone::app
