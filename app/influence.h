// --weight-by, --weights, --lock, --keep-border: where a model matters more, and what stays.
#pragma once

#include "app/command_line.h"
#include "app/spec.h"
#include "lodestone/chain/influence.h"

namespace lodestone::app {

OptionGroup method_group();

/// Reads the options, and the file of --weights. Errors: bad_argument, cannot_read, bad_format (with the line).
Result<chain::Influence> influence_of(const Arguments& arguments);

}  // namespace lodestone::app
