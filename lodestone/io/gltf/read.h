// glTF 2.0 in: .gltf with its buffers and images, or .glb.
#pragma once

#include <filesystem>
#include <string>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/model.h"
#include "lodestone/io/read.h"

namespace lodestone::io {

/// Reads a .glb or .gltf, told apart by content. meshes[i] is the file's mesh i, groups[g] its g-th triangle primitive
/// (triangles, strips, fans); points and lines stay in the document only. Vertices are welded exactly by position
/// across the primitives of a mesh. Instances: nodes with a mesh under the default scene (else the first scene, else
/// all nodes without a parent), depth first; skins and morph targets are not applied. KHR_draco_mesh_compression,
/// KHR_meshopt_compression, EXT_meshopt_compression, KHR_mesh_quantization and EXT_mesh_gpu_instancing are decoded. UVs
/// start at the top (Model::uv_origin_top). Memory: the file, the meshes, and one mesh more while it is welded.
/// Errors: cannot_read, bad_format (naming accessor, buffer view, primitive or node), unsupported (glTF 1, an extension
/// that this build lacks), empty (no triangle drawn), out_of_memory, cancelled.
Result<Model> read_gltf(const std::filesystem::path& path, const ReadOptions& options = {}, Task task = {});

/// The same from bytes in memory; `name` stands in errors. Names of other files in it are refused: only a GLB chunk and
/// data URIs can hold its bytes.
Result<Model> read_gltf_bytes(std::string bytes, std::string name, Task task = {});

}  // namespace lodestone::io
