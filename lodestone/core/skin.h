// Skin influences: which joints pull at a wedge, and how much.
#pragma once

#include <cstddef>

#include "lodestone/core/mesh.h"

namespace lodestone {

/// Wedges that more than `most` joints pull at. O(mesh).
std::size_t wedges_above(const Mesh& mesh, std::size_t most);

/// Leaves the `most` heaviest influences of each wedge, their sum as before, in the first sets; sets that are then
/// empty everywhere vanish. 4 is what engines take; 0 = all stay. O(mesh).
void limit_influences(Mesh& mesh, std::size_t most);

}  // namespace lodestone
