// Normals after simplification: never stale, never against the face.
#pragma once

#include <cstdint>
#include <vector>

#include "lodestone/core/mesh.h"

namespace lodestone {

/// Puts the normals (and tangents) of a simplified mesh in order. Where the original was flat-shaded (its corner
/// normals are its face normals) so is the result, with wedges split as that needs. Elsewhere a corner normal that
/// points against its face (more than 90 degrees off) is replaced by the face's. Tangents are made orthogonal to the
/// normals again. `origin`: the original's triangle of each triangle. `untouched`: one an original triangle, non-zero =
/// its corners stay as they are; empty = none. O(mesh).
void repair_corner_normals(const Mesh& original, const std::vector<std::uint32_t>& origin, Mesh& mesh,
                           const std::vector<std::uint8_t>& untouched = {});

}  // namespace lodestone
