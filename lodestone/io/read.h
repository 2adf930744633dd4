// Reading models: one door for every format.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/model.h"

namespace lodestone::io {

struct ReadOptions {
  /// Whether levels that a glTF file has of its own (MSFT_lod) are kept in its document. Without them what is written
  /// anew has no levels of the old geometry.
  bool levels = true;
  /// Which level of a glTF file's ladder (MSFT_lod) the instances draw: 0 = the original. A node with fewer levels
  /// draws its coarsest. With `levels` the model is for looking at, not for writing; without them its document is as
  /// well that of this level alone.
  std::size_t draw_level = 0;
};

/// Reads a model by its extension (any case), checked against the content: PLY, OBJ, STL, OFF, glTF, GLB, DRC and,
/// where built in, what assimp reads. Every mesh comes out validated, welded exactly and without unused vertices. Faces
/// with more than three corners are triangulated; non-manifold, duplicate and degenerate faces stay. Errors:
/// cannot_read, bad_format (with place), unsupported, empty (no triangle in the file), out_of_memory, cancelled.
Result<Model> read_model(const std::filesystem::path& path, const ReadOptions& options = {}, Task task = {});

/// True if read_model knows the extension.
bool is_model_extension(std::string_view extension);

/// True if the format is read by a library that is not ours (assimp, Draco's bare files): commands read these in a
/// child process with limits on time and memory.
bool is_foreign_extension(std::string_view extension);

/// Extensions with the dot, lower case, ours first: {".ply", ".obj", …}.
std::vector<std::string> readable_extensions();

}  // namespace lodestone::io
