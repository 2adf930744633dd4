// The long tail of formats, read by the assimp library where it is built in (LODESTONE_WITH_ASSIMP).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/model.h"

namespace lodestone::io {

/// Extensions with the dot that read_assimp is for, whether it is built in or not.
std::vector<std::string> assimp_extensions();

/// Reads meshes, the node hierarchy as instances, materials (name, diffuse colour, diffuse texture: embedded or beside
/// the file), UV sets, normals, tangents and colours. Meshes that assimp split by material stay apart. Bones,
/// animations, cameras and lights are left out with a warning. The library is known to crash or hang on some broken
/// files: programs that meet such call this in a child process. Errors: cannot_read, bad_format (in assimp's words),
/// unsupported (not built in), empty, out_of_memory, cancelled.
Result<Model> read_assimp(const std::filesystem::path& path, Task task = {});

}  // namespace lodestone::io
