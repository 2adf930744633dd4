// Scenes as one mesh.
#pragma once

#include <string>
#include <vector>

#include "lodestone/core/model.h"

namespace lodestone {

/// All instances as one mesh: positions, normals and tangents transformed, mirrored ones turned so that faces stay
/// outward, groups joined. Streams are matched by name, meaning and shape; one that a drawn mesh lacks is left out and
/// told. The offset is the first drawn mesh's (or the translation of its instance, where that is large), so that
/// precision is kept.
Mesh flatten_to_mesh(const Model& model, std::vector<std::string>& warnings);

/// The model as one mesh placed once, in world space, without the document that it came from; as it is where it is
/// that already. What is lost is told in `warnings`.
Model flattened(Model model, std::vector<std::string>& warnings);

}  // namespace lodestone
