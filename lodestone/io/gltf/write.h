// glTF 2.0 out: a model, or a ladder with MSFT_lod.
#pragma once

#include <filesystem>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/level.h"
#include "lodestone/io/write.h"

namespace lodestone::io {

/// Writes a ladder as "name.glb" (one file) or "name.gltf" + "name.bin".
///
/// From a glTF document, what level 0 had comes out as it went in; its meshes' own accessors are kept unless the mesh
/// was changed, was Draco-compressed, or compression is asked for. Coarser levels: each drawn node that carries a mesh
/// gets `MSFT_lod` with coarser nodes outside the scene. A node with children, a transform animation, a camera, a light
/// or a role as joint hands its mesh and skin to a new identity leaf that carries it. Weight animations are repeated
/// for each level. The binary chunk holds the coarsest level first. A level whose mesh has no triangle left is a node
/// without one. From no document: a fresh one with a node an instance.
///
/// Nothing is rounded that an error was measured on: compression is lossless (meshopt without filters, Draco without
/// quantization; primitives with morph targets stay plain under Draco, with a warning), and positions of a quantized
/// file are stored as its integers only where these hold them exactly, else as floats. Other attributes keep the
/// source's component type. Extensions of a primitive that describe its old geometry stay with level 0 only.
/// Errors: cannot_write (also: a GLB above 4 GiB), bad_argument (levels that don't fit the original; those of
/// validate()), unsupported (compression not built in), bad_format (the original's JSON has members of wrong types),
/// out_of_memory, cancelled.
Result<WriteReport> write_gltf(const Ladder& ladder, const std::filesystem::path& path,
                               const WriteOptions& options = {}, Task task = {});

/// Writes one model, without levels. Errors: as above.
Result<WriteReport> write_gltf(const Model& model, const std::filesystem::path& path, const WriteOptions& options = {},
                               Task task = {});

}  // namespace lodestone::io
