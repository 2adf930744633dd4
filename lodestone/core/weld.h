// Exact welding: vertices at equal positions become one, equal wedges become one.
#pragma once

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/mesh.h"

namespace lodestone {

/// Merges vertices whose three coordinates are equal (-0 equals 0) and wedges of one vertex whose attributes are equal bit
/// for bit; drops vertices and wedges that no triangle uses. The first of equals in index order stays, order is kept.
/// Triangles, groups and their order are untouched; triangles may become degenerate. Every reader ends with this.
/// O(wedges), memory about 24 bytes a wedge. Errors: cancelled.
Result<Mesh> weld_exact(Mesh mesh, Task task = {});

}  // namespace lodestone
