// What must hold for every Mesh, so that no operation has to ask again.
#pragma once

#include "lodestone/base/result.h"
#include "lodestone/core/mesh.h"
#include "lodestone/core/model.h"

namespace lodestone {

/// Checks indices in range, stream sizes, group indices, finite positions and offset. O(size).
/// Errors: bad_format naming the first offender; `where` is the mesh's name.
Result<void> validate(const Mesh& mesh);
/// All meshes, and that instances name meshes and have finite transforms.
Result<void> validate(const Model& model);

}  // namespace lodestone
