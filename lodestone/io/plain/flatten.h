// Scenes as one mesh.
#pragma once

#include <string>
#include <vector>

#include "lodestone/core/model.h"

namespace lodestone::io {

/// The model as one mesh placed once, in world space, without the document that it came from; as it is where it is
/// that already. What is lost is told in `warnings`.
Model flattened(Model model, std::vector<std::string>& warnings);

}  // namespace lodestone::io
