// PLY out.
#pragma once

#include <filesystem>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/model.h"
#include "lodestone/io/write.h"

namespace lodestone::io {

/// Writes the whole scene as one mesh, binary little-endian: a vertex a wedge, doubles where the model has an offset,
/// attributes under the names and types that a PLY had, others under the usual ones (nx ny nz, s t, red green blue).
/// Colours keep their type. Where the drawn materials have one texture and the mesh has UVs, it is named by `comment
/// TextureFile` and written beside the PLY; both files appear or none. Textures that are left out are told.
/// Errors: bad_argument (those of validate()), empty (nothing drawn), cannot_write, cancelled.
Result<WriteReport> write_ply(const Model& model, const std::filesystem::path& path, Task task = {});

}  // namespace lodestone::io
