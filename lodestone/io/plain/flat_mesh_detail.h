// One mesh in world space from a model, for formats without a scene.
#pragma once

#include <string>
#include <vector>

#include "lodestone/core/model.h"

namespace lodestone::io {

/// All instances as one mesh: positions, normals and tangents transformed, mirrored ones turned so that faces stay
/// outward, groups joined. Streams are matched by name, meaning and shape; one that a drawn mesh lacks is left out and
/// told. The offset is the first drawn mesh's (or the translation of its instance, where that is large), so that
/// precision is kept.
Mesh flatten_to_mesh(const Model& model, std::vector<std::string>& warnings);

}  // namespace lodestone::io
