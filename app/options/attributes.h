// --attribute-weights, --influences, --tangents: what becomes of attributes in coarser levels.
#pragma once

#include "app/options/command_line.h"
#include "app/options/spec.h"
#include "lodestone/chain/ladder/constraints.h"

namespace lodestone::app {

OptionGroup level_attributes_group();

/// Reads the options into `constraints`. Errors: bad_argument.
Result<void> read_attribute_options(const Arguments& arguments, chain::SimplifyConstraints& constraints);

/// Warns of wedges whose skin influences are cut, and of weights for streams that the model has not.
void tell_of_attributes(const Model& model, const chain::SimplifyConstraints& constraints,
                        std::vector<std::string>& warnings);

}  // namespace lodestone::app
