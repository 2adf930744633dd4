// Writing models and ladders: one door for every format. Same model, same bytes.
#pragma once

#include <cstddef>
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
/// .gltf (+ .bin). All or nothing: see base/file.h. Instances are flattened where the format has none. Older files of
/// these names are replaced, but see check_replaced(); a texture beside the model never replaces a file with other
/// bytes.
/// Errors: cannot_write, unsupported, bad_argument (compression that the format has not; those of validate()),
/// cancelled.
Result<WriteReport> write_model(const Model& model, const std::filesystem::path& path, const WriteOptions& options = {},
                                Task task = {});

/// Writes a ladder. "name.glb" or "name.gltf": all levels in one file with MSFT_lod, the coarsest level first in the
/// binary chunk. "name_LOD{level}.ext": a file a level. Anything else is bad_argument with both spellings named.
/// Errors: as above.
Result<WriteReport> write_ladder(const Ladder& ladder, const std::filesystem::path& path,
                                 const WriteOptions& options = {}, Task task = {});

/// What write_model and write_ladder refuse about a name alone, to be told before the work that leads to them.
/// Errors: unsupported (extension), bad_argument (compression that the format has not; a ladder in one plain file).
Result<void> check_model_name(const std::filesystem::path& path, Compression compression);
Result<void> check_ladder_name(const std::filesystem::path& path, Compression compression);

/// What they refuse to replace, as far as it shows before textures are written; `levels` counts for a "{level}" name.
/// Neither the output nor its .bin or .mtl may be a file that the input was read from (Model::files), and the .bin or
/// .mtl replaces an older one only beside an older output. A model may be written over itself, with all that belongs to
/// it. Errors: cannot_write, with the file and the way out.
Result<void> check_replaced(const Model& input, const std::filesystem::path& path, std::size_t levels = 1);

/// True if write_model knows the extension (with the dot, any case).
bool is_writable_extension(std::string_view extension);

}  // namespace lodestone::io
