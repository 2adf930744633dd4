// Writing models and ladders: one door for every format. Same model, same bytes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/level.h"
#include "lodestone/core/model.h"

namespace lodestone::io {

/// How geometry is coded in glTF. Other formats take none.
enum class Compression { none, meshopt, draco };

struct WriteOptions {
  Compression compression = Compression::none;
  /// glTF ladders: MSFT_screencoverage, one row an instance of the original, one value a level, the last 0.
  /// Empty = the extra is left out.
  std::vector<std::vector<double>> screen_coverage;
};

struct WriteReport {
  std::vector<std::filesystem::path> files;  ///< file of each level (the same for all in one GLB)
  std::vector<std::uint64_t> level_bytes;    ///< bytes that each level takes: its share of a GLB, or its own file
  std::uint64_t total_bytes = 0;
  std::vector<std::string> warnings;  ///< what the format could not hold, in plain words
};

/// Writes one model, by the path's extension: .ply (binary little-endian), .obj (+ .mtl), .stl (binary), .off, .glb,
/// .gltf
/// (+ .bin). All or nothing: see base/file.h. Instances are flattened where the format has none.
/// Errors: cannot_write, unsupported, cancelled.
Result<WriteReport> write_model(const Model& model, const std::filesystem::path& path, const WriteOptions& options = {},
                                Task task = {});

/// Writes a ladder. "name.glb" or "name.gltf": all levels in one file with MSFT_lod, the coarsest level first in the
/// binary chunk. "name_LOD{level}.ext": a file a level. Anything else is bad_argument with both spellings named.
Result<WriteReport> write_ladder(const Ladder& ladder, const std::filesystem::path& path,
                                 const WriteOptions& options = {}, Task task = {});

/// True if write_model knows the extension (with the dot, any case).
bool is_writable_extension(std::string_view extension);

}  // namespace lodestone::io
