// Exact welding: vertices at equal positions become one, equal wedges become one.
#pragma once

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/mesh.h"

namespace lodestone {

/// Merges vertices whose three coordinates are equal (-0 equals 0) and wedges of one vertex whose attributes are equal
/// bit for bit; drops vertices and wedges that no triangle uses. The first of equals in index order stays, order is
/// kept. Triangles, groups and their order are untouched; triangles may become degenerate. Every reader ends with this.
/// O(wedges), memory about 24 bytes a wedge. Errors: bad_argument (those of validate_indices()), cancelled.
Result<Mesh> weld_exact(Mesh mesh, Task task = {});

/// For each wedge the lowest wedge of the same vertex whose tuples are equal in all streams with `compared[stream]`
/// set. With normals left out, wedges that differ in nothing else fall together. O(wedges).
std::vector<std::uint32_t> wedge_classes(const Mesh& mesh, const std::vector<bool>& compared, Task task = {});

}  // namespace lodestone
