// Getting at inputs and outputs: reading a model, listing a directory, refusing to overwrite an input.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/children/volume_input.h"
#include "app/options/command_line.h"
#include "app/output/console.h"
#include "lodestone/base/result.h"
#include "lodestone/base/task.h"
#include "lodestone/core/model.h"
#include "lodestone/io/read.h"
#include "lodestone/io/write.h"

namespace lodestone::app {

/// Reads a model, or the surface of a volume, and tells its warnings. Formats read by other people's libraries are read
/// in a child process. Errors: those of io::read_model and io::read_volume; bad_argument for a directory without
/// slices, as the verb takes a single file.
Result<Model> read_input(const std::filesystem::path& path, const Console& console, Task task,
                         const io::ReadOptions& options = {}, const VolumeRequest& volume = {});

/// Whether an output is one model, or may have "{level}" in its name and be a file a level.
enum class OutputKind { one_model, levels };

/// Checks before the work begins that `output` can be written: a format we write, one that holds the compression, an
/// existing folder with permission, not a directory nor write-protected, and none of `inputs`. "{level}" in the name
/// stands for any number.
/// What else must not be replaced shows when the input is read: io::check_replaced(). Errors: bad_argument,
/// cannot_write.
Result<void> check_output(const std::filesystem::path& output, const std::vector<std::filesystem::path>& inputs,
                          io::Compression compression, OutputKind kind = OutputKind::one_model);

/// Whether a file has a level. Errors: bad_argument.
Result<void> check_level(const std::string& input, std::size_t level);

/// Whether a name stands for a file a level.
bool is_level_pattern(const std::filesystem::path& output);

/// The part of check_output() that holds for files of any kind: the folder, and that no input is replaced.
Result<void> check_place(const std::filesystem::path& output, const std::vector<std::filesystem::path>& inputs);

/// What the error says when -o is missing.
tl::unexpected<Error> missing_output(const std::string& verb, const std::string& input);
/// "to write x.glb, use -o x.glb" where the last of several inputs is no file yet and -o is missing; else empty.
std::string forgotten_output(const Arguments& arguments);

/// The files of a directory that are models by their extension, by name. Errors: cannot_read, empty.
Result<std::vector<std::filesystem::path>> models_in(const std::filesystem::path& directory);

/// Largest resident size of this process so far, bytes.
std::uint64_t peak_memory_bytes();

}  // namespace lodestone::app
