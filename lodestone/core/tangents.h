// Tangents from positions, normals and texture coordinates.
#pragma once

#include "lodestone/core/mesh.h"

namespace lodestone {

/// Makes the tangent stream anew: along growing u of the first UV set, orthogonal to the normal, handedness -1
/// where the texture is mirrored, else +1 (glTF 2.0, section 3.7.2.1). Triangles count by their angle at the corner. A
/// wedge whose texture says nothing keeps its tangent. Does nothing without tangents, normals or UVs as floats.
/// O(mesh).
void rebuild_tangents(Mesh& mesh);

/// Leaves the tangents out, those of morph targets, too: viewers then make their own.
void drop_tangents(Mesh& mesh);

}  // namespace lodestone
